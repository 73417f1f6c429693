/// @file
/// A made-up reconstructed separation with round numbers.

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/reconstruction/separation.h"
#include "services/reports/separation_report.h"

namespace spindrift::testing {

/// 2026-03-01T04:00:00Z.
inline constexpr std::int64_t kSeparation_tai_ns = 1'772'337'637'000'000'000;

/// Returns an attitude with (phi, theta, psi) = (10, 20, 30) deg at T1, psi growing by a degree
/// every ten seconds, and a sigma of 0.4 deg, of which noise alone would leave half.
inline ReconstructedAttitude made_attitude(double t_s) {
  const double sigma_rad = 0.4 * kRadPerDeg;
  return {.t = shifted(tai_from_ns(kSeparation_tai_ns), t_s),
          .q_icrf_body = quaternion_of({.phi_rad = 10.0 * kRadPerDeg,
                                        .theta_rad = 20.0 * kRadPerDeg,
                                        .psi_rad = (30.0 + 0.1 * t_s) * kRadPerDeg}),
          .rate_body_rad_s = {0.001, -0.002, 0.003},
          .covariance_rad2 = sigma_rad * sigma_rad / 3.0 * Eigen::Matrix3d::Identity(),
          .noise_covariance_rad2 = 0.25 * sigma_rad * sigma_rad / 3.0 * Eigen::Matrix3d::Identity(),
          .rate_covariance_rad2_s2 = 1e-8 * Eigen::Matrix3d::Identity()};
}

/// Returns a reconstruction with T1 to T4 at 0, 60, 78 and 300 s and a history every ten seconds.
/// `batch` has a Cramer-Rao bound and a bias that is unobservable along the Sun; in the orbit frame
/// the attitude is (1, 2, 3) deg, except at T3 where it is missing.
inline ReconstructedSeparation made_separation(ReconstructionMethod method) {
  using enum SeparationEvent;
  const bool is_batch = method == ReconstructionMethod::Batch;
  Reconstruction solution{
      .method = method,
      .events = {},
      .history = {},
      .bias = std::nullopt,
      .misalignment = std::nullopt,
      .open_bias = {},
      .gyro = {.count = 961, .outliers = 2, .noise = 1.0},
      .sun = {.count = 223},
      .star = {.count = 1},
      .assessment = {.quality = Quality::Ok,
                     .reasons = {{ReasonCode::StarFixes, {{"count", std::int64_t{1}}}}}},
      .iterations = 4};
  for (const auto& [event, t_s] : {std::pair{Separation, 0.0}, std::pair{ControlOn, 60.0},
                                   std::pair{Acquisition, 78.0}, std::pair{FirstStarFix, 300.0}}) {
    solution.events.push_back(
        {.event = event,
         .found = event == FirstStarFix,
         .attitude = made_attitude(t_s),
         .bound_rad = is_batch ? std::optional{0.35 * kRadPerDeg} : std::nullopt});
  }
  for (int i = 0; i <= 30; ++i) {
    solution.history.push_back(made_attitude(10.0 * i));
  }
  if (is_batch) {
    solution.bias = GyroBias{.rad_s = Eigen::Vector3d{0.003, -0.002, 0.004} * kRadPerDeg,
                             .covariance_rad2_s2 = 1e-10 * Eigen::Matrix3d::Identity()};
    solution.open_bias = {{.axis_body = Eigen::Vector3d::UnitZ(),
                           .sigma_rad_s = 0.009 * kRadPerDeg,
                           .share = 0.9,
                           .off_sun_rad = 2.0 * kRadPerDeg}};
  }
  const Euler312Reading reading{.angles = {.phi_rad = 1.0 * kRadPerDeg,
                                           .theta_rad = 2.0 * kRadPerDeg,
                                           .psi_rad = 3.0 * kRadPerDeg},
                                .near_singular = false};
  return {
      .solution = std::move(solution),
      .in_orbit_frame = {reading, reading,
                         Unexpected{{ErrorCode::NoCoverage, "the orbit ends before"}}, reading},
      .launcher = LauncherCheck{.q_icrf_body = Eigen::Quaterniond::Identity(),
                                .difference = {.angle_rad = 3.9 * kRadPerDeg, .chi_square = 60.0},
                                .chance = 1e-12}};
}

inline ReconstructionProduct made_product(ReconstructionMethod method) {
  return std::make_shared<const ReconstructedSeparation>(made_separation(method));
}

/// Returns a report with both methods.
inline SeparationReport made_report() {
  return {.spacecraft_id = "LEOSAT",
          .run_id = "run-1",
          .methods = {made_product(ReconstructionMethod::Batch),
                      made_product(ReconstructionMethod::Sequential)}};
}

/// Returns a report with `batch` alone after a change.
template <class Change>
SeparationReport report_after(const Change& change) {
  ReconstructedSeparation separation = made_separation(ReconstructionMethod::Batch);
  change(separation);
  return {.spacecraft_id = "LEOSAT",
          .run_id = "run-1",
          .methods = {std::make_shared<const ReconstructedSeparation>(separation)}};
}

}  // namespace spindrift::testing
