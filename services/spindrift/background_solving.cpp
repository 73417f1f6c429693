#include "services/spindrift/background_solving.h"

#include <pthread.h>
#include <sched.h>
#include <spdlog/spdlog.h>

#include <future>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

namespace spindrift {
namespace {

/// Nobody waits for the solution of a minute, and everybody for fixes: it gets what processor time
/// they leave.
void give_way_to_other_threads() {
  const sched_param none{};
  const int failed = pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
  static std::once_flag said;
  if (failed != 0) {
    std::call_once(said, [failed] {
      spdlog::warn("batch solutions compete with fixes for the processor: {}",
                   std::generic_category().message(failed));
    });
  }
}

/// In a thread that does nothing else: one that gives way must not hold the archive's locks, and
/// without privileges none can cease to give way.
Expected<ArchiveBatch> solve_giving_way(const BackgroundTask& task) {
  return std::async(std::launch::async,
                    [&task] {
                      give_way_to_other_threads();
                      return task.solve();
                    })
      .get();
}

}  // namespace

void solve_in_background(BoundedQueue<BackgroundTask>& tasks, Archive& archive,
                         const Patience& patience) {
  std::map<std::string, std::string> said;
  while (const auto task = tasks.take()) {
    if (patience.ended) {
      continue;
    }
    auto solution = solve_giving_way(*task);
    if (!solution) {
      std::string& reason = said[task->spacecraft_id];
      if (std::exchange(reason, solution.error().message) != solution.error().message) {
        spdlog::warn("{}: no batch solution: {}", task->spacecraft_id, reason);
      }
    } else if (!archive.submit(*std::move(solution))) {
      tasks.close();  // Those who compute meet the same archive, and say so.
    }
  }
}

}  // namespace spindrift
