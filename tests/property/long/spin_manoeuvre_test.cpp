#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_manoeuvre_test {

constexpr double kStep_s = 200.0;
constexpr double kEnd_s = 500.0;

struct Scene : Surroundings {
  /// Runs a pass in which the body `before` is replaced by `after` at `kStep_s`.
  SpinOutput run(const SpinningBody& before, const SpinningBody& after,
                 std::mt19937_64& rng) const {
    std::vector<Pulse> seen = pulses(before, 0.0, kStep_s, rng);
    const std::vector<Pulse> later = pulses(after, kStep_s, kEnd_s, rng);
    seen.insert(seen.end(), later.begin(), later.end());
    std::sort(seen.begin(), seen.end());
    return testing::run(SpinPass{before.config, orbit}, seen);
  }
};

void expect_near(const SpinEstimate& estimate, const SpinningBody& body) {
  SCOPED_TRACE(sentence_of(estimate.assessment));
  const double off_rad = angle_between_rad(estimate.axis_icrf, body.axis_icrf);
  EXPECT_LT(off_rad, 0.2 * kRadPerDeg);
  EXPECT_LT(off_rad, 4.0 * sigma_rad(estimate));
  EXPECT_NEAR(estimate.spin_rate_rad_s, body.rate_rad_s, 5.0 * estimate.spin_rate_sigma_rad_s);
}

TEST(SpinManoeuvre, EstimatesFollowAnAxisThatMoves) {
  const Scene scene;
  std::mt19937_64 rng{611};
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const SpinningBody before = random_body(scene.around, 3.0 * kRadPerDeg, rng);
    const Eigen::Vector3d earth_icrf = scene.around.earth_icrf_km(kStep_s).normalized();
    SpinningBody after = before;
    after.axis_icrf = Eigen::AngleAxisd{10.0 * kRadPerDeg, earth_icrf} * before.axis_icrf;
    const SpinOutput output = scene.run(before, after, rng);
    const SpinEstimate mean = last_estimate(output, SpinEstimator::Mean);
    const SpinEstimate sequential = last_estimate(output, SpinEstimator::Sequential);
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
    const SpinningBody before = random_body(scene.around, 3.0 * kRadPerDeg, rng);
    SpinningBody after = before;
    after.rate_rad_s *= factor;
    const SpinOutput output = scene.run(before, after, rng);
    const SpinEstimate sequential = last_estimate(output, SpinEstimator::Sequential);
    expect_near(last_estimate(output, SpinEstimator::Mean), after);
    expect_near(sequential, after);
    EXPECT_TRUE(is_unopposed(sequential.assessment.quality));
  }
}

TEST(SpinManoeuvre, NothingIsSaidOfOneWhereThereIsNone) {
  const Scene scene;
  std::mt19937_64 rng{613};
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const SpinningBody body = random_body(scene.around, 8.0 * kRadPerDeg, rng);
    const SpinOutput output =
        testing::run(SpinPass{body.config, scene.orbit}, scene.pulses(body, 0.0, 60.0, rng));
    EXPECT_FALSE(restarted(last_estimate(output, SpinEstimator::Sequential).assessment));
    EXPECT_FALSE(has(last_estimate(output, SpinEstimator::Mean).assessment, ReasonCode::Since));
  }
}

}  // namespace spindrift::testing::spin_manoeuvre_test
