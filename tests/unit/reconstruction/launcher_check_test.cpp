#include <limits>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/separation.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"

namespace spindrift::launcher_check_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const TaiTime kSeparation = tai_from_ns(1'772'337'637'000'000'000);
const std::optional<Orbit> kOrbit{testing::low_orbit(kSeparation, 2.0)};

Euler312 euler312_of_deg(double phi, double theta, double psi) {
  return {phi * kRadPerDeg, theta * kRadPerDeg, psi * kRadPerDeg};
}

// Source: Li 2017, the launcher's attitude and the reconstructed one.
const Euler312 kTold = euler312_of_deg(0.229, 0.2869, 179.72);
const Euler312 kFound = euler312_of_deg(-0.5155, 1.3194, 176.0337);

Quaterniond in_icrf(const Euler312& angles) {
  return orbit_frame(kOrbit->at(kSeparation).value()).value() * quaternion_of(angles);
}

ReconstructedAttitude found(const Quaterniond& q_icrf_body, double sigma_deg) {
  return {.t = kSeparation,
          .q_icrf_body = q_icrf_body,
          .rate_body_rad_s = Vector3d::Zero(),
          .covariance_rad2 = std::pow(sigma_deg * kRadPerDeg, 2) * Matrix3d::Identity(),
          .noise_covariance_rad2 = Matrix3d::Identity(),
          .rate_covariance_rad2_s2 = Matrix3d::Identity()};
}

TEST(LauncherCheck, GivesTheDifferenceOfThePaper) {
  const auto check = value_or_throw(
      launcher_check({InOrbitFrame{kTold}, 0.5 * kRadPerDeg}, found(in_icrf(kFound), 1.2), kOrbit));
  EXPECT_NEAR(degrees(check.difference.angle_rad), 3.9, 0.05);
  // Sigmas of 0.5 and 1.2 deg combine to 1.3 deg.
  const double sigmas = degrees(check.difference.angle_rad) / 1.3;
  EXPECT_NEAR(check.difference.chi_square, sigmas * sigmas, 1e-9);
  EXPECT_NEAR(check.chance, 0.029, 0.001);
  EXPECT_LT(angle_between_rad(check.q_icrf_body, in_icrf(kTold)), 1e-12);
}

TEST(LauncherCheck, SaysThatTheSameIsTheSame) {
  const auto check =
      launcher_check({InOrbitFrame{kTold}, 0.01}, found(in_icrf(kTold), 0.5), kOrbit).value();
  EXPECT_NEAR(check.difference.angle_rad, 0.0, 1e-12);
  EXPECT_NEAR(check.chance, 1.0, 1e-9);
}

/// The launch inertial frame is fixed in inertial space, so half an hour of flight changes nothing.
TEST(LauncherCheck, GoesTheChainOfALaunchWithoutAnOrbit) {
  const Launch launch{{5.2 * kRadPerDeg, -52.8 * kRadPerDeg}, 1.6, shifted(kSeparation, -1800.0)};
  const Quaterniond q_launch_body = launch_frame(launch).conjugate() * in_icrf(kFound);
  const LauncherAttitude told{InLaunchFrame{euler312_of(q_launch_body).angles, launch}, 0.01};
  const auto check =
      value_or_throw(launcher_check(told, found(in_icrf(kFound), 0.5), std::nullopt));
  EXPECT_LT(angle_between_rad(check.q_icrf_body, in_icrf(kFound)), 1e-12);
  EXPECT_NEAR(check.chance, 1.0, 1e-9);
}

TEST(LauncherCheck, SaysWhatItLacks) {
  const auto attitude = found(in_icrf(kFound), 0.5);
  EXPECT_THAT(launcher_check({InOrbitFrame{kTold}, 0.01}, attitude, std::nullopt),
              IsRefused(ErrorCode::Unobservable, HasSubstr("no orbit is known")));
  for (const double sigma_rad : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(launcher_check({InOrbitFrame{kTold}, sigma_rad}, attitude, kOrbit),
                IsRefused(ErrorCode::InvalidConfiguration, _));
  }
}

}  // namespace spindrift::launcher_check_test
