#include "services/serving/background_solving.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "services/base/warning.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

constexpr std::chrono::milliseconds kPatiencePoll{200};

/// Lowers the thread to idle priority: fixes are awaited, the solution of a minute is not.
void give_way_to_other_threads() {
  const sched_param none{};
  const int failed = pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
  static std::once_flag said;
  if (failed != 0) {
    std::call_once(said, [failed] {
      warn("no_idle_priority", {{"errno", failed}},
           "batch solutions compete with fixes for the processor: " +
               std::generic_category().message(failed));
    });
  }
}

// Set when the thread of an unfinished solution was left running.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> given_up = false;

using Solved = Expected<std::vector<Product>>;

/// A thread that only solves: a thread that gives way must not hold locks of the archive.
struct Attempt {
  std::future<Solved> solved;
  std::thread thread;
};

Attempt attempt(const BackgroundTask& task, bool gives_way) {
  std::packaged_task<Solved()> solving{[task, gives_way] {
    if (gives_way) {
      task.is_awaited ? let_samples_come_first() : give_way_to_other_threads();
    }
    return task.solve();
  }};
  auto solved = solving.get_future();
  return {.solved = std::move(solved), .thread = std::thread{std::move(solving)}};
}

/// Solves a task on a thread that gives way until the service is told to stop. From then on no fix
/// waits for the processor, but a thread cannot raise its priority again without privileges, and
/// among busy processes it would take minutes. So a second thread solves the same task at the usual
/// priority, and the first result counts. The other thread is left running, as both are when
/// patience ends. @return Empty when patience ended first.
std::optional<Solved> solve(const BackgroundTask& task, const Patience& patience) {
  std::vector<Attempt> attempts;
  bool gives_way = !patience.stopping;
  attempts.push_back(attempt(task, gives_way));
  auto ready = attempts.end();
  while (ready == attempts.end() && !patience.ended) {
    if (gives_way && patience.stopping) {
      gives_way = false;
      attempts.push_back(attempt(task, gives_way));
    }
    attempts.back().solved.wait_for(kPatiencePoll);
    ready = std::find_if(attempts.begin(), attempts.end(), [](const Attempt& one) {
      return one.solved.wait_for(std::chrono::seconds{0}) == std::future_status::ready;
    });
  }
  for (auto one = attempts.begin(); one != attempts.end(); ++one) {
    given_up = given_up || one != ready;
    one == ready ? one->thread.join() : one->thread.detach();
  }
  return ready == attempts.end() ? std::nullopt : std::optional{ready->solved.get()};
}

}  // namespace

void let_samples_come_first() {
  constexpr int kNice = 10;
  if (setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice) != 0) {
    warn("no_lower_priority", {{"errno", errno}},
         "the backlog competes with samples for the processor: " +
             std::generic_category().message(errno));
  }
}

bool is_solution_given_up() { return given_up; }

std::size_t solve_in_background(BoundedQueue<BackgroundTask>& tasks, Archive& archive,
                                const Patience& patience) {
  std::map<std::string, std::string> said;
  std::map<std::string, std::size_t> left;
  while (auto task = tasks.take()) {
    const std::string& spacecraft = task->batch.spacecraft_id;
    if (patience.ended) {
      ++left[spacecraft];
      continue;
    }
    auto products = solve(*task, patience);
    if (!products) {
      ++left[spacecraft];
      continue;
    }
    if (*products) {
      if (task->summary != nullptr) {
        task->summary->count_solution(**products);
      }
      task->batch.products = **std::move(products);
    } else {
      std::string& reason = said[spacecraft];
      if (std::exchange(reason, products->error().message) != products->error().message) {
        task->batch.products.emplace_back(
            told("no_solution", {{"spacecraft", spacecraft}, {"what", task->what}, {"why", reason}},
                 fmt::format("{}: no {}: {}", spacecraft, task->what, reason)));
      }
    }
    if (row_count(task->batch) > 0 && !archive.submit(std::move(task->batch))) {
      tasks.close();  // The computing threads report the archive's refusal.
    }
  }
  std::size_t all_left = 0;
  for (const auto& [spacecraft, count] : left) {
    all_left += count;
    warn("solutions_not_computed", {{"spacecraft", spacecraft}, {"solutions", count}},
         fmt::format("{}: {} solution{} not computed yet: the next start of the service will",
                     spacecraft, count, count == 1 ? " is" : "s are"));
  }
  return all_left;
}

}  // namespace spindrift
