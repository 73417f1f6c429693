/// @file
/// The Kalman update in Joseph form, in which rounding makes no variance negative, and the limits
/// of its iteration for directions, that of Gauss and Newton.

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace spindrift {

/// Updates an error state of `kState` components by a measurement of `kSize` components.
template <int kState, int kSize>
struct LinearUpdate {
  using Covariance = Eigen::Matrix<double, kState, kState>;
  using Slope = Eigen::Matrix<double, kSize, kState>;
  using Noise = Eigen::Matrix<double, kSize, kSize>;

  /// @param slope Derivative of the measurement by the error state.
  LinearUpdate(const Covariance& covariance, const Slope& slope, const Noise& noise)
      : slope{slope}, noise{noise} {
    const Eigen::Matrix<double, kState, kSize> shared = covariance * slope.transpose();
    expected = slope * shared + noise;
    if constexpr (kSize == 1) {
      gain = shared / expected(0, 0);
    } else {
      gain = expected.llt().solve(shared.transpose()).transpose();
    }
  }

  /// Returns the covariance of the error after the update.
  Covariance left_of(const Covariance& covariance) const {
    const Covariance left = Covariance::Identity() - gain * slope;
    return left * covariance * left.transpose() + gain * noise * gain.transpose();
  }

  Slope slope;
  Noise noise;
  Noise expected;  ///< Covariance of the innovation.
  Eigen::Matrix<double, kState, kSize> gain;
};

/// A larger correction (0.06 deg) is linearised again at its result.
inline constexpr double kFarFromLinear_rad = 1e-3;
/// Largest number of linearisations.
inline constexpr int kMostLinearisations = 8;

}  // namespace spindrift
