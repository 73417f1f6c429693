#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::spin_manoeuvre_test {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kStep_s = 200.0;
constexpr double kEnd_s = 500.0;

struct Scene {
  Orbit orbit = testing::transfer_orbit();
  testing::SunEarthEphemeris around =
      testing::seen_from(orbit, testing::spherical_horizon_km(40.0));

  std::vector<Pulse> seen(const testing::SpinningBody& body, double from_s, double to_s,
                          std::mt19937_64& rng) const {
    return testing::pulses_from(testing::edges_between(body, around, from_s, to_s),
                                testing::kTransferStart, body.config.noise, rng);
  }
  /// Runs a pass in which the body `before` is replaced by `after` at `kStep_s`.
  SpinOutput run(const testing::SpinningBody& before, const testing::SpinningBody& after,
                 std::mt19937_64& rng) const {
    std::vector<Pulse> pulses = seen(before, 0.0, kStep_s, rng);
    const std::vector<Pulse> later = seen(after, kStep_s, kEnd_s, rng);
    pulses.insert(pulses.end(), later.begin(), later.end());
    std::sort(pulses.begin(), pulses.end());
    return testing::run(SpinPass{before.config, orbit}, pulses);
  }
};

void expect_near(const SpinEstimate& estimate, const testing::SpinningBody& body) {
  SCOPED_TRACE(sentence_of(estimate.assessment));
  const double off_rad = angle_between_rad(estimate.axis_icrf, body.axis_icrf);
  EXPECT_LT(off_rad, 0.2 * kRadPerDeg);
  EXPECT_LT(off_rad, 4.0 * testing::sigma_rad(estimate));
  EXPECT_NEAR(estimate.spin_rate_rad_s, body.rate_rad_s, 5.0 * estimate.spin_rate_sigma_rad_s);
}

TEST(SpinManoeuvre, EstimatesFollowAnAxisThatMoves) {
  const Scene scene;
  std::mt19937_64 rng{611};
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const testing::SpinningBody before = testing::random_body(scene.around, 3.0 * kRadPerDeg, rng);
    const Eigen::Vector3d earth_icrf = scene.around.earth_icrf_km(kStep_s).normalized();
    testing::SpinningBody after = before;
    after.axis_icrf = Eigen::AngleAxisd{10.0 * kRadPerDeg, earth_icrf} * before.axis_icrf;
    const SpinOutput output = scene.run(before, after, rng);
    const SpinEstimate mean = testing::last_estimate(output, SpinEstimator::Mean);
    const SpinEstimate sequential = testing::last_estimate(output, SpinEstimator::Sequential);
    expect_near(mean, after);
    expect_near(sequential, after);
    EXPECT_TRUE(has(mean.assessment, ReasonCode::Since));
    EXPECT_LE(sentence_of(mean.assessment).size(), 63U);
    EXPECT_TRUE(is_unopposed(sequential.assessment.quality));
    EXPECT_EQ(std::count_if(output.notices.begin(), output.notices.end(),
                            [](const Notice& notice) {
                              return notice.code == NoticeCode::AxisMoved ||
                                     notice.code == NoticeCode::PriorContradicted;
                            }),
              1);
  }
}

TEST(SpinManoeuvre, EstimatesFollowARateThatSteps) {
  const Scene scene;
  std::mt19937_64 rng{612};
  for (const double factor : {0.9, 1.02, 1.15}) {
    SCOPED_TRACE(factor);
    const testing::SpinningBody before = testing::random_body(scene.around, 3.0 * kRadPerDeg, rng);
    testing::SpinningBody after = before;
    after.rate_rad_s *= factor;
    const SpinOutput output = scene.run(before, after, rng);
    expect_near(testing::last_estimate(output, SpinEstimator::Mean), after);
    expect_near(testing::last_estimate(output, SpinEstimator::Sequential), after);
    EXPECT_TRUE(
        is_unopposed(testing::last_estimate(output, SpinEstimator::Sequential).assessment.quality));
  }
}

TEST(SpinManoeuvre, NothingIsSaidOfOneWhereThereIsNone) {
  const Scene scene;
  std::mt19937_64 rng{613};
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const testing::SpinningBody body = testing::random_body(scene.around, 8.0 * kRadPerDeg, rng);
    const SpinOutput output =
        testing::run(SpinPass{body.config, scene.orbit}, scene.seen(body, 0.0, 60.0, rng));
    EXPECT_FALSE(
        testing::restarted(testing::last_estimate(output, SpinEstimator::Sequential).assessment));
    EXPECT_FALSE(
        has(testing::last_estimate(output, SpinEstimator::Mean).assessment, ReasonCode::Since));
  }
}

}  // namespace spindrift::spin_manoeuvre_test
