#include "services/serving/background_solving.h"

#include <sched.h>

#include <future>
#include <thread>
#include <vector>

#include "services/archive/archive.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::background_solving_test {

/// A solution at background priority gets no time on a busy machine; after a stop it must be ready
/// as early as one at normal priority.
TEST(BackgroundSolving, NothingGivesWayAnyMoreOnceTheServiceStops) {
  const TemporaryFolder folder;
  auto archive = Archive::open(folder.path() / "solved.db", {});
  ASSERT_TRUE(archive) << archive.error().message;
  std::promise<void> giving_way;
  std::promise<void> solved;
  const std::shared_future<void> other_is_ready = solved.get_future().share();
  BoundedQueue<BackgroundTask> tasks{1};
  tasks.push({.batch = {}, .solve = [&, other_is_ready]() -> Expected<std::vector<Product>> {
                if (sched_getscheduler(0) == SCHED_IDLE) {
                  giving_way.set_value();
                  other_is_ready.wait();
                } else {
                  solved.set_value();
                }
                return std::vector<Product>{};
              }});
  tasks.close();
  Patience patience;
  std::thread stop{[&] {
    giving_way.get_future().wait();
    patience.stopping = true;
  }};
  EXPECT_EQ(solve_in_background(tasks, **archive, patience), 0);
  stop.join();
  EXPECT_TRUE(is_solution_given_up());
}

}  // namespace spindrift::background_solving_test
