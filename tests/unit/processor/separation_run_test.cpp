#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "services/processor/three_axis_run.h"
#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"
#include "tests/support/outcome.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::separation_run_test {

std::vector<std::string_view> methods_in(const std::vector<Product>& products) {
  std::vector<std::string_view> methods;
  for (const ReconstructionProduct& one : of_kind<ReconstructionProduct>(products)) {
    methods.push_back(method_of(one));
  }
  return methods;
}

class SeparationRunTest : public ::testing::Test {
 protected:
  Mission mission() const {
    Mission mission{};
    mission.spacecraft_id = "SAT";
    mission.config = flight_.sensors;
    mission.separation = {.times = {.separation = flight_.times.separation}, .launcher = {}};
    return mission;
  }
  ThreeAxisRun run(SolvingPlan plan) const { return {mission(), "run-1", plan}; }

  template <class Value>
  static void add(const std::vector<Value>& values, PassInput& input) {
    for (const Value& value : values) {
      input.values.of<Value>().push_back({.place = next_place(input), .value = value});
    }
  }
  /// Returns the whole pass with the star fix last.
  PassInput whole_pass() const {
    PassInput input{.spacecraft = 0, .run_id = "run-1"};
    add(flight_.gyro, input);
    add(flight_.sun, input);
    add(flight_.stars, input);
    return input;
  }

  SeparationFlight flight_ = separation_flight({}, 1);
};

TEST_F(SeparationRunTest, HandsOutBatchAndThenSequentialWhenTheStarFixComes) {
  ThreeAxisRun run = this->run(SolvingPlan::Meanwhile);
  run.compute(whole_pass());
  const auto tasks = run.take_background_tasks();
  ASSERT_THAT(tasks, SizeIs(2));
  for (const auto& [task, method] : {std::pair{tasks[0], "batch"}, {tasks[1], "sequential"}}) {
    EXPECT_TRUE(task.is_awaited);
    EXPECT_EQ(task.batch.run_id, "run-1");
    EXPECT_FALSE(task.batch.finished_utc);
    const auto products = value_or_throw(task.solve());
    EXPECT_THAT(methods_in(products), ElementsAre(method));
  }
  EXPECT_THAT(run.take_background_tasks(), IsEmpty());
}

TEST_F(SeparationRunTest, AtTheEndBothAreMadeOfAllSamples) {
  for (const auto plan : {SolvingPlan::AtTheEnd, SolvingPlan::Meanwhile}) {
    ThreeAxisRun run = this->run(plan);
    run.compute(whole_pass());
    if (plan == SolvingPlan::AtTheEnd) {
      EXPECT_THAT(run.take_background_tasks(), IsEmpty());
    }
    const ArchiveBatch last = run.finish();
    EXPECT_TRUE(last.finished_utc);
    EXPECT_THAT(methods_in(last.products), ElementsAre("batch", "sequential"));
    const RunSummary summary = run.summaries().front();
    ASSERT_THAT(summary.reconstructions, SizeIs(2));
    EXPECT_EQ(summary.reconstructions.front()->samples,
              static_cast<std::int64_t>(sample_count(whole_pass())));
  }
}

TEST_F(SeparationRunTest, RestsOnNothingThatAnOperatorHasLeftOut) {
  ThreeAxisRun run = this->run(SolvingPlan::AtTheEnd);
  OperatorAction no_sun{};
  no_sun.t = TaiTime{};
  no_sun.does = AttitudeAction{ExcludeChannel<SampleKind>{SampleKind::Sun}};
  run.compute({.spacecraft = 0, .run_id = "run-1", .actions = {{.place = {}, .value = no_sun}}});
  run.compute(whole_pass());
  run.finish();
  EXPECT_EQ(run.summaries().front().reconstructions.front()->samples,
            static_cast<std::int64_t>(sample_count(whole_pass()) - flight_.sun.size()));
}

TEST_F(SeparationRunTest, AnotherRunIsFinishedBehindItsSolutions) {
  ThreeAxisRun run = this->run(SolvingPlan::Meanwhile);
  run.compute(whole_pass());
  run.take_background_tasks();
  for (const ArchiveBatch& batch : run.compute({.spacecraft = 0, .run_id = "run-2"})) {
    EXPECT_FALSE(batch.finished_utc);
  }
  auto tasks = run.take_background_tasks();
  ASSERT_THAT(tasks, SizeIs(1));
  EXPECT_TRUE(tasks[0].batch.finished_utc);
  EXPECT_EQ(tasks[0].batch.run_id, "run-1");
  tasks[0].summary->count_solution(tasks[0].solve().value());
  const auto summaries = run.summaries();
  EXPECT_EQ(summaries[0].run_id, "run-1");
  EXPECT_THAT(summaries[0].reconstructions, SizeIs(2));
  EXPECT_THAT(summaries[1].reconstructions, IsEmpty());
}

TEST_F(SeparationRunTest, WhatIsStoredOfARunThatGoesOnIsNotSolvedAgain) {
  const auto all = static_cast<std::int64_t>(sample_count(whole_pass()));
  ThreeAxisRun run = this->run(SolvingPlan::Meanwhile);
  run.go_on("run-1", {{"run-1",
                       {.again_from = TaiTime::max(),
                        .batches = {},
                        .reconstructed = {{"batch", all}, {"sequential", all - 1}}}}});
  run.compute(whole_pass());
  const auto tasks = run.take_background_tasks();
  ASSERT_THAT(tasks, SizeIs(1));
  EXPECT_THAT(methods_in(tasks[0].solve().value()), ElementsAre("sequential"));
}

TEST_F(SeparationRunTest, WithoutAStarFixTheRunEndsWithoutOne) {
  flight_.stars.clear();
  ThreeAxisRun run = this->run(SolvingPlan::Meanwhile);
  run.compute(whole_pass());
  EXPECT_THAT(run.take_background_tasks(), IsEmpty());
  const ArchiveBatch last = run.finish();
  EXPECT_TRUE(last.finished_utc);
  EXPECT_THAT(methods_in(last.products), IsEmpty());
}

TEST(BackgroundTask, WhatASolutionThrowsIsAFaultOfItsRun) {
  const auto products =
      solved_or_fault("SAT", "solution", tai_from_ns(7), []() -> Expected<std::vector<Product>> {
        throw std::runtime_error{"no"};
      }).value();
  ASSERT_THAT(products, SizeIs(1));
  const auto& fault = std::get<RunFault>(products.front());
  EXPECT_EQ(fault.t, tai_from_ns(7));
  EXPECT_EQ(fault.what, "no");
}

}  // namespace spindrift::testing::separation_run_test
