#include "pipelines/spin/mean/mean_estimator.h"

#include <Eigen/Geometry>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/base/assessment_words.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/product_text.h"

namespace spindrift::testing::mean_estimator_test {

/// Feeds the estimator with revolutions of a constant scene.
class Pass {
 public:
  /// Adds one revolution.
  /// @param turned_rad Rotation of the fix away from its angles.
  SpinEstimate next(double turned_rad = 0.0) {
    const Revolution revolution = noisy(scene_, scene_.seen(), rng_);
    const RevolutionMeasurements measured = measure(scene_.config, revolution);
    SpinFix fix = lone_fix(scene_.config, revolution, {}, scene_.sun_earth()).value();
    fix.revolution = ++number_;
    fix.axis_icrf = Eigen::AngleAxisd{turned_rad, Eigen::Vector3d::UnitX()} * fix.axis_icrf;
    mean_.keep(number_, measured, scene_.sun_earth());
    EXPECT_TRUE(mean_.add_fix(fix));
    return mean_.estimate(revolution);
  }
  SpinEstimate begin_anew() {
    mean_.begin_anew(scene_.start);
    return mean_.estimate(scene_.seen());
  }
  double off_rad(const SpinEstimate& mean) const {
    return angle_between_rad(mean.axis_icrf, scene_.axis_icrf);
  }

 private:
  AxisScene scene_;
  std::mt19937_64 rng_{41};
  MeanEstimator mean_{scene_.config};
  std::int64_t number_ = 0;
};

Reason fixes(std::int64_t count) { return {ReasonCode::Fixes, {{"count", count}}}; }

Assessment too_few(std::int64_t count) {
  return {Quality::Doubtful,
          {fixes(count), Reason{ReasonCode::FewFixes, {{"needed", std::int64_t{3}}}}}};
}

TEST(MeanEstimator, OneOrTwoFixesAreDoubtfulAndThreeAreNot) {
  Pass pass;
  EXPECT_EQ(pass.next().assessment, too_few(1));
  EXPECT_EQ(pass.next().assessment, too_few(2));
  const SpinEstimate mean = pass.next();
  EXPECT_EQ(mean.assessment, (Assessment{Quality::Converging, {fixes(3)}}));
  EXPECT_LT(pass.off_rad(mean), 3.0 * sigma_rad(mean));
}

TEST(MeanEstimator, WhatIsGivenUpIsLostUntilAFixComes) {
  Pass pass;
  pass.next();
  pass.next();
  const SpinEstimate last = pass.next();
  for (const SpinEstimate& lost : {pass.begin_anew(), pass.begin_anew()}) {
    EXPECT_EQ(lost.assessment, (Assessment{Quality::Lost, {Reason{ReasonCode::AwaitingFix, {}}}}));
    EXPECT_EQ(lost.axis_icrf, last.axis_icrf);
    EXPECT_GT(sigma_rad(lost), 90.0 * kRadPerDeg);
  }
  EXPECT_EQ(pass.next().assessment, too_few(1));
}

TEST(MeanEstimator, FixesThatAreNotWhatTheirAnglesSayAreDoubtful) {
  for (const double turned_deg : {4.0, 20.0, 90.0}) {
    SCOPED_TRACE(turned_deg);
    Pass pass;
    for (int i = 0; i < 20; ++i) {
      const SpinEstimate mean = pass.next(turned_deg * kRadPerDeg);
      EXPECT_TRUE(mean.assessment.quality == Quality::Doubtful) << sentence_of(mean.assessment);
      EXPECT_TRUE(i < 2 || pass.off_rad(mean) < 3.0 * sigma_rad(mean))
          << sentence_of(mean.assessment);
    }
  }
}

}  // namespace spindrift::testing::mean_estimator_test
