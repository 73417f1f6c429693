#include "pipelines/ephemeris/flight_frames.h"
#include "tests/support/matchers.h"

namespace spindrift::orbit_frame_test {

constexpr double kRounding = 4e-15;

TEST(OrbitFrame, LooksDownAheadAndAgainstTheNormal) {
  // The spacecraft is over the equator at longitude 90 deg and moves north and slightly up, as
  // after perigee.
  const auto q =
      orbit_frame({.position_icrf_km = {0.0, 7000.0, 0.0}, .velocity_icrf_km_s = {0.0, 0.5, 7.5}})
          .value();
  const Eigen::Matrix3d R = q.toRotationMatrix();
  EXPECT_NEAR((R.col(2) - Eigen::Vector3d{0.0, -1.0, 0.0}).norm(), 0.0, kRounding);
  EXPECT_NEAR((R.col(0) - Eigen::Vector3d{0.0, 0.0, 1.0}).norm(), 0.0, kRounding);
  // The normal, position x velocity, is +x.
  EXPECT_NEAR((R.col(1) - Eigen::Vector3d{-1.0, 0.0, 0.0}).norm(), 0.0, kRounding);
}

TEST(OrbitFrame, WithoutANormalThereIsNone) {
  const auto falling = orbit_frame(
      {.position_icrf_km = {7000.0, 100.0, -3.0}, .velocity_icrf_km_s = {-7.0, -0.1, 0.003}});
  EXPECT_THAT(falling, IsRefused(ErrorCode::Unobservable, _));
  EXPECT_NE(falling.error().message.find("(-7, -0.1, 0.003) km/s"), std::string::npos)
      << falling.error().message;
  EXPECT_FALSE(orbit_frame(
      {.position_icrf_km = Eigen::Vector3d::Zero(), .velocity_icrf_km_s = {1.0, 0.0, 0.0}}));
}

}  // namespace spindrift::orbit_frame_test
