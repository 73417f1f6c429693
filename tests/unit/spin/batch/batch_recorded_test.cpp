#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/product_text.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/solved_pass.h"
#include "tests/support/stepped_orbit.h"

namespace spindrift::testing::batch_recorded_test {

Expected<BatchSolution> solved(const RecordedPass& recorded) {
  return testing::solved(recorded.config, recorded.orbit, run(recorded));
}

struct Recorded {
  const char* name;
  HorizonModel horizon;
  double limit_deg;
};

class BatchOfRecordedPass : public ::testing::TestWithParam<Recorded> {};

TEST_P(BatchOfRecordedPass, IsWithinItsLimitAndThreeSigmas) {
  RecordedPass recorded = recorded_pass(GetParam().name);
  recorded.config.horizon.model = GetParam().horizon;
  const auto solution = solved(recorded);
  ASSERT_TRUE(solution) << solution.error().message;
  const SpinEstimate& estimate = solution->estimate;
  const double error_deg =
      angle_between_rad(estimate.axis_icrf, recorded.true_axis_icrf) / kRadPerDeg;
  EXPECT_LT(error_deg, GetParam().limit_deg);
  EXPECT_LT(error_sigmas(estimate, recorded.true_axis_icrf), 3.0);
}

INSTANTIATE_TEST_SUITE_P(Passes, BatchOfRecordedPass,
                         ::testing::Values(Recorded{"nominal", HorizonModel::Sphere, 0.05},
                                           Recorded{"dirty", HorizonModel::Ellipsoid, 0.05},
                                           Recorded{"coded", HorizonModel::Sphere, 0.1},
                                           Recorded{"north-only", HorizonModel::Sphere, 0.1},
                                           Recorded{"gms5", HorizonModel::Ellipsoid, 0.02}),
                         [](const auto& recorded) {
                           std::string name = recorded.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(BatchOfRecorded, HasTheGridOfItsTimesInItsSigma) {
  const RecordedPass recorded = recorded_pass("../faults/times-in-ms");
  const auto solution = solved(recorded);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->estimate.assessment.quality, Quality::Ok);
  EXPECT_LT(error_sigmas(solution->estimate, recorded.true_axis_icrf), 4.0);
}

TEST(BatchOfRecorded, DoubtsAStepOfTheOrbitWithinThePass) {
  RecordedPass recorded = recorded_pass("nominal");
  const OemSegment segment = of_few_points(recorded.orbit.ephemeris()->segments().front());
  const TaiTime begins = recorded.pulses.front().t;
  for (const double after_s : {240.0, -100.0}) {
    recorded.orbit = Orbit{
        stepped(segment, shifted(begins, after_s), Eigen::Vector3d::Zero(), {0.0, 0.0, 0.12})};
    const auto solution = solved(recorded);
    ASSERT_TRUE(solution) << solution.error().message;
    EXPECT_EQ(has(solution->estimate.assessment, ReasonCode::OrbitSteps), after_s > 0.0);
    EXPECT_FALSE(after_s > 0.0 && is_unopposed(solution->estimate.assessment.quality));
  }
}

}  // namespace spindrift::testing::batch_recorded_test
