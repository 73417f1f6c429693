#include "services/serving/verdict_watch.h"

#include <chrono>
#include <memory>
#include <string>

#include "services/alerts/alert_desk.h"
#include "services/base/bell.h"
#include "services/base/bounded_queue.h"
#include "services/mission/mission.h"
#include "services/serving/thread_failures.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/recorded_files.h"

namespace spindrift::verdict_watch_test {

using namespace std::chrono_literals;

class Verdicts : public testing::ArchiveFixture {
 protected:
  const std::vector<Mission> missions_{load_mission(kPasses / "nominal" / "mission.toml").value()};
};

TEST_F(Verdicts, AreReadAtOnceWhenThereAreNewAnswers) {
  const auto archive = open();
  commit(*archive, testing::start_of("run-1"));
  AlertDesk desk{missions_, RunMode::Live};
  desk.take_up_run("SPINNER", "run-1");
  Bell new_answers;
  ThreadFailures failures;
  BoundedQueue<PassVerdict> read{100};
  const VerdictWatch watch{path(),
                           {"SPINNER"},
                           desk,
                           new_answers,
                           [&](const auto& /*spacecraft*/, const auto& /*run_id*/,
                               const PassVerdict& verdict) { read.push(verdict); },
                           failures};
  ASSERT_EQ(read.take()->quality, std::nullopt);
  commit(*archive,
         testing::with_products(testing::batch_of("run-1"),
                                {testing::estimate_at(1, SpinEstimator::Sequential, 20.0)}));
  const auto told = std::chrono::steady_clock::now();
  new_answers.ring();
  EXPECT_EQ(read.take()->quality, Quality::Ok);
  EXPECT_LT(std::chrono::steady_clock::now() - told, 500ms);
}

}  // namespace spindrift::verdict_watch_test
