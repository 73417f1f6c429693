#include "services/processor/three_axis_run.h"

#include <random>

#include "tests/support/matchers.h"
#include "tests/support/of_kind.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::three_axis_run_test {

Mission mission() {
  Mission mission{};
  mission.spacecraft_id = "SAT";
  mission.config = usual_three_axis();
  return mission;
}

class ThreeAxisRunTest : public ::testing::Test {
 protected:
  template <class Value>
  void add(const Value& value) {
    input_.values.of<Value>().push_back({.place = next_place(input_), .value = value});
  }
  void gyro(double from_s, double to_s) {
    for (int i = 0; from_s + 0.25 * i < to_s; ++i) {
      add(sensors_.gyro(from_s + 0.25 * i));
    }
  }
  /// Computes the input added since the last call.
  std::vector<ArchiveBatch> compute() {
    return run_.compute(std::exchange(input_, PassInput{.spacecraft = 0, .run_id = input_.run_id}));
  }
  static std::vector<TaiTime> attitudes_in(const std::vector<ArchiveBatch>& batches) {
    std::vector<TaiTime> times;
    for (const ArchiveBatch& batch : batches) {
      for (const AttitudeEstimate& attitude : of_kind<AttitudeEstimate>(batch.products)) {
        times.push_back(attitude.t);
      }
    }
    return times;
  }

  std::mt19937_64 rng_{7};
  TurningBody body_ = TurningBody::smooth(rng_, 60.0, 0.02);
  Sensors sensors_{body_, usual_three_axis(), rng_};
  PassInput input_{.spacecraft = 0, .run_id = "run-1"};
  ThreeAxisRun run_{mission(), "run-1", SolvingPlan::Meanwhile};
};

TEST_F(ThreeAxisRunTest, GivesTheFirstAttitudeWithTheSampleThatReleasesItsStarFix) {
  gyro(0.0, 1.0);
  add(sensors_.star(1.0));
  gyro(1.0, 2.0);
  EXPECT_THAT(compute(), IsEmpty());
  add(sensors_.gyro(2.0));
  EXPECT_THAT(attitudes_in(compute()), ElementsAre(at_s(1.0)));
}

TEST_F(ThreeAxisRunTest, ASilenceBringsOutWhatIsHeld) {
  gyro(0.0, 1.0);
  add(sensors_.star(1.0));
  gyro(1.0, 2.0);
  input_.silences = {next_place(input_)};
  EXPECT_THAT(attitudes_in(compute()), ElementsAre(at_s(1.0), at_s(1.25), at_s(1.5), at_s(1.75)));
}

TEST_F(ThreeAxisRunTest, AnotherRunEndsTheOneBefore) {
  gyro(0.0, 1.0);
  add(sensors_.star(1.0));
  gyro(1.0, 1.5);
  EXPECT_THAT(compute(), IsEmpty());
  input_.run_id = "run-2";
  add(sensors_.gyro(50.0));
  const auto ended = compute();
  ASSERT_THAT(ended, SizeIs(1));
  EXPECT_EQ(ended[0].run_id, "run-1");
  EXPECT_TRUE(ended[0].finished_utc);
  EXPECT_THAT(attitudes_in(ended), ElementsAre(at_s(1.0), at_s(1.25)));

  const auto summaries = run_.summaries();
  ASSERT_THAT(summaries, SizeIs(2));
  EXPECT_EQ(summaries[0].attitude.value().t, at_s(1.25));
  EXPECT_FALSE(summaries[1].attitude);
}

TEST_F(ThreeAxisRunTest, SummaryHasTheHealthOfItsSensorsAndWhyTheirSamplesWereLeftOut) {
  gyro(0.0, 2.0);
  add(sensors_.star(1.0));
  add(GyroSample{.t = at_s(2.0), .rate_body_rad_s = Eigen::Vector3d::Constant(1.0)});
  gyro(2.25, 10.0);
  add(sensors_.star(3.0));
  compute();
  run_.finish();
  const RunSummary summary = run_.summaries().front();
  EXPECT_EQ(summary.kind, SpacecraftKind::ThreeAxis);
  const SensorHealth& gyro = summary.sensors.at(index_of(SampleKind::Gyro));
  EXPECT_EQ(gyro.accepted, 39);
  EXPECT_EQ(gyro.rejected, 1);
  EXPECT_EQ(gyro.last_seen, at_s(9.75));
  using Counts = std::map<std::string_view, std::int64_t>;
  EXPECT_EQ(summary.samples_rejected.at(index_of(SampleKind::Gyro)), (Counts{{"saturated", 1}}));
  EXPECT_EQ(summary.samples_rejected.at(index_of(SampleKind::Star)), (Counts{{"late", 1}}));
  EXPECT_EQ(summary.attitude.value().t, at_s(9.75));
}

}  // namespace spindrift::testing::three_axis_run_test
