#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/recorded_pass.h"
#include "tests/support/stepped_orbit.h"

namespace spindrift::batch_recorded_test {

Expected<BatchSolution> solved(const testing::RecordedPass& recorded) {
  SpinPass pass{recorded.config, recorded.orbit};
  PassEdges edges;
  const auto note = [&edges](const SpinOutput& output) {
    for (const SpinProduct& product : output.products) {
      edges.note(product);
    }
  };
  for (const Pulse& pulse : recorded.pulses) {
    note(pass.push(pulse));
  }
  for (const CodedFrame& frame : recorded.frames) {
    note(pass.push(frame));
  }
  note(pass.finish());
  const auto starts = edges.starts(recorded.config.prior);
  return solve_batch(recorded.config, recorded.orbit, std::move(edges).edges(), starts);
}

struct Recorded {
  const char* name;
  HorizonModel horizon;
  double limit_deg;
};

class BatchOfRecordedPass : public ::testing::TestWithParam<Recorded> {};

TEST_P(BatchOfRecordedPass, IsWithinItsLimitAndThreeSigmas) {
  testing::RecordedPass recorded = testing::recorded_pass(GetParam().name);
  recorded.config.horizon.model = GetParam().horizon;
  const auto solution = solved(recorded);
  ASSERT_TRUE(solution) << solution.error().message;
  const SpinEstimate& estimate = solution->estimate;
  const double error_deg =
      angle_between_rad(estimate.axis_icrf, recorded.true_axis_icrf) / kRadPerDeg;
  const double sigma_deg = std::sqrt(estimate.covariance_rad2.trace()) / kRadPerDeg;
  EXPECT_LT(error_deg, GetParam().limit_deg);
  EXPECT_LT(error_deg, 3.0 * sigma_deg);
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

double sigmas_off(const testing::RecordedPass& recorded, const SpinEstimate& estimate) {
  return angle_between_rad(estimate.axis_icrf, recorded.true_axis_icrf) /
         std::sqrt(estimate.covariance_rad2.trace());
}

TEST(BatchOfRecorded, HasTheGridOfItsTimesInItsSigma) {
  const testing::RecordedPass recorded = testing::recorded_pass("../faults/times-in-ms");
  const auto solution = solved(recorded);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->estimate.assessment.quality, Quality::Ok);
  EXPECT_LT(sigmas_off(recorded, solution->estimate), 4.0);
}

TEST(BatchOfRecorded, DoubtsAStepOfTheOrbitWithinThePass) {
  testing::RecordedPass recorded = testing::recorded_pass("nominal");
  const OemSegment segment = testing::of_few_points(recorded.orbit.ephemeris()->segments().front());
  const TaiTime begins = recorded.pulses.front().t;
  for (const double after_s : {240.0, -100.0}) {
    recorded.orbit = Orbit{testing::stepped(segment, shifted(begins, after_s),
                                            Eigen::Vector3d::Zero(), {0.0, 0.0, 0.12})};
    const auto solution = solved(recorded);
    ASSERT_TRUE(solution) << solution.error().message;
    EXPECT_EQ(has(solution->estimate.assessment, ReasonCode::OrbitSteps), after_s > 0.0);
    EXPECT_FALSE(after_s > 0.0 && is_unopposed(solution->estimate.assessment.quality));
  }
}

}  // namespace spindrift::batch_recorded_test
