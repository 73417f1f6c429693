#include "pipelines/supervision/attitude_conditions.h"

#include <gtest/gtest.h>

namespace spindrift::attitude_conditions_test {

AttitudeEstimate estimate(double t_s, Quality quality) {
  return {.t = shifted(tai_from_ns(1'795'143'637'000'000'000), t_s),
          .q_icrf_body = Eigen::Quaterniond::Identity(),
          .rate_body_rad_s = std::nullopt,
          .covariance_rad2 = 1e-8 * Eigen::Matrix3d::Identity(),
          .assessment = {.quality = quality}};
}

TEST(AttitudeConditions, RaiseThatTheAttitudeIsLostAndClearItWhenItIsBack) {
  AttitudeConditions conditions{AlertLimits{}};
  const auto nominal = conditions.see(estimate(0.0, Quality::Ok));
  ASSERT_EQ(nominal.size(), 1U);
  EXPECT_EQ(nominal.front().change, Change::Cleared);
  const auto lost = conditions.see(estimate(1.0, Quality::Lost));
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_EQ(lost.front().code, AlertCode::AttitudeLost);
  EXPECT_EQ(lost.front().change, Change::Raised);
  const auto back = conditions.see(estimate(2.0, Quality::Converging));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back.front().change, Change::Cleared);
}

}  // namespace spindrift::attitude_conditions_test
