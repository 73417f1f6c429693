#include <Eigen/Geometry>
#include <functional>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/sequential/contradiction.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing::start_confirmation_test {

constexpr double kFixSigma_rad = 4.0 * kRadPerDeg;
const Eigen::Vector3d kAxis_icrf = Eigen::Vector3d{0.3, -0.5, 0.8}.normalized();

StartingPoint known_to(double sigma_rad, double off_rad = 0.0) {
  return {.axis_icrf = Eigen::AngleAxisd{off_rad, kAxis_icrf.unitOrthogonal()} * kAxis_icrf,
          .covariance_rad2 = 0.5 * sigma_rad * sigma_rad * Eigen::Matrix2d::Identity()};
}

StartConfirmation after(int fixes, const StartingPoint& followed,
                        const std::function<void(SpinFix&)>& change = {}) {
  std::mt19937_64 rng{5};
  StartConfirmation start;
  start.begin(known_to(2.8 * kRadPerDeg));
  for (int i = 0; i < fixes; ++i) {
    SpinFix fix = drawn_fix(kAxis_icrf, kFixSigma_rad, rng);
    if (change) {
      change(fix);
    }
    start.add_fix(fix, followed);
  }
  return start;
}

TEST(StartConfirmation, AnAxisKnownToADegreeNeedsNoConfirmation) {
  StartConfirmation start;
  start.begin(known_to(1.5 * kRadPerDeg));
  EXPECT_TRUE(start.unconfirmed());
  start.begin(known_to(0.9 * kRadPerDeg));
  EXPECT_FALSE(start.unconfirmed());
}

TEST(StartConfirmation, FixesConfirmItWhenTheirMeanIsKnownToADegree) {
  // With 4 deg in either direction the mean of 32 fixes is known to a degree.
  const StartingPoint followed = known_to(0.5 * kRadPerDeg);
  EXPECT_TRUE(after(30, followed).unconfirmed());
  EXPECT_FALSE(after(40, followed).unconfirmed());
}

TEST(StartConfirmation, FixesThatLieElsewhereDoNot) {
  EXPECT_TRUE(after(100, known_to(0.5 * kRadPerDeg, 4.0 * kRadPerDeg)).unconfirmed());
}

TEST(StartConfirmation, NorDoFixesThatProveNothing) {
  const StartingPoint followed = known_to(0.5 * kRadPerDeg);
  EXPECT_TRUE(after(100, followed, [](SpinFix& fix) { fix.accepted = false; }).unconfirmed());
  EXPECT_TRUE(after(100, followed, [](SpinFix& fix) { fix.near_tangent = true; }).unconfirmed());
}

}  // namespace spindrift::testing::start_confirmation_test
