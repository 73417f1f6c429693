/// @file
/// The rescue of a body by its magnetometer alone, on the ground model.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/flights/rescue_motion.h"
#include "services/mission/igrf.h"
#include "tests/support/low_orbit.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {

/// Returns a body that tumbles by a degree a second about each axis (one sigma) from any attitude,
/// to be turned to the orbit frame.
inline RescueTruth tumbling_to_rescue(std::uint64_t seed, double end_s) {
  std::mt19937_64 rng{seed};
  const Eigen::Vector3d moments_kg_m2{60.0, 50.0, 70.0};
  return {.body = {.start = at_s(0.0),
                   .at_start = {.q_icrf_body = any_attitude(rng),
                                .rate_body_rad_s = normal_vector(rng, 1.0 * kRadPerDeg)},
                   .inertia_kg_m2 = moments_kg_m2.asDiagonal(),
                   .end_s = end_s},
          .magnetometer = {.sampling = {.from_s = 0.0, .step_s = 1.0},
                           .noise_nt = 100.0,
                           .bias_nt = Eigen::Vector3d::Zero(),
                           .field = igrf().value()},
          .control = {.commanded = {.frame = NominalAttitude::Frame::Orbit,
                                    .q_frame_body = Eigen::Quaterniond::Identity()},
                      .failure = std::nullopt,
                      .thrusters = {.torque_nm = 0.5, .shortest_s = 0.02, .longest_s = 1.0},
                      .moments_kg_m2 = moments_kg_m2,
                      .frequency_rad_s = 0.1,
                      .damping = 0.8,
                      .slew_rad_s = 0.5 * kRadPerDeg,
                      .period_s = 1.0},
          .filter = {.inertia_kg_m2 = moments_kg_m2.asDiagonal()}};
}

inline Expected<Rescue> rescued(const RescueTruth& truth, std::uint64_t seed) {
  Chance chance{seed};
  return rescue_motion(truth, low_orbit(at_s(0.0), 0.37 * static_cast<double>(seed)), chance);
}

/// Returns whether thrusters were commanded while control should be off.
inline bool fires_while_lost(const Rescue& rescue) {
  return std::any_of(rescue.record.begin(), rescue.record.end(), [](const RescueRecord& now) {
    return (now.phase == RescuePhase::Lost || now.phase == RescuePhase::Pointing) &&
           !now.torque_nm.isZero(0.0);
  });
}

}  // namespace spindrift::testing
