/// @file
/// Noisy candidates for a spin axis, of branches that stay or drift.

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/disambiguation/dispersion.h"

namespace spindrift::testing {

inline constexpr double kSigma_rad = 0.3 * kRadPerDeg;

inline AxisCandidate candidate(const Eigen::Vector3d& axis_icrf, double sigma_rad) {
  return {.axis_icrf = axis_icrf,
          .covariance_rad2 = sigma_rad * sigma_rad * Eigen::Matrix2d::Identity(),
          .norm = 1.0,
          .consistent = true,
          .model_shift_icrf = Eigen::Matrix<double, 3, kModelErrors>::Zero()};
}

/// Draws noisy axes: one that is constant, and others that drift.
class NoisyAxes {
 public:
  explicit NoisyAxes(std::uint64_t seed) : rng_{seed} {}

  AxisCandidate seen(const Eigen::Vector3d& axis_icrf, double sigma_rad = kSigma_rad) {
    const Eigen::Vector2d off_rad{sigma_rad * normal_(rng_), sigma_rad * normal_(rng_)};
    return candidate((axis_icrf + tangent_basis(axis_icrf) * off_rad).normalized(), sigma_rad);
  }

 private:
  std::mt19937_64 rng_;
  std::normal_distribution<double> normal_;
};

inline const Eigen::Vector3d kTrue_icrf = Eigen::Vector3d{0.1, -0.05, 1.0}.normalized();

/// Returns an axis that starts 40 deg from the true one and moves across that direction.
inline Eigen::Vector3d drifting(double moved_rad) {
  const Eigen::Vector3d start =
      Eigen::AngleAxisd{40.0 * kRadPerDeg, Eigen::Vector3d::UnitY()} * kTrue_icrf;
  return Eigen::AngleAxisd{moved_rad, Eigen::Vector3d::UnitX()} * start;
}

/// Gives each of many passes two constant axes, one twice as noisy, as its covariance states.
inline void expect_noise_alone_settles_nothing(std::uint64_t passes) {
  for (std::uint64_t seed = 0; seed < passes; ++seed) {
    NoisyAxes axes{1000 + seed};
    Dispersion dispersion{100};
    dispersion.note_unlike();  // Each branch has noise of its own here.
    for (int revolution = 0; revolution < 300; ++revolution) {
      const std::array candidates{axes.seen(kTrue_icrf),
                                  axes.seen(drifting(0.0), 2.0 * kSigma_rad)};
      ASSERT_FALSE(dispersion.add(candidates)) << seed;
    }
  }
}

}  // namespace spindrift::testing
