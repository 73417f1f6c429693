/// @file
/// The Kalman update of the error of a state by one measurement, in Joseph's form: no variance
/// becomes negative by rounding, however much was unknown before.

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace spindrift {

/// The state's error has `kState` components, the measurement `kSize`.
template <int kState, int kSize>
struct LinearUpdate {
  using Covariance = Eigen::Matrix<double, kState, kState>;
  using Slope = Eigen::Matrix<double, kSize, kState>;
  using Noise = Eigen::Matrix<double, kSize, kSize>;

  /// @param slope Change of the measurement with the error.
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

  /// Of the error that is left.
  Covariance left_of(const Covariance& covariance) const {
    const Covariance left = Covariance::Identity() - gain * slope;
    return left * covariance * left.transpose() + gain * noise * gain.transpose();
  }

  Slope slope;
  Noise noise;
  Noise expected;  ///< Covariance of the innovation.
  Eigen::Matrix<double, kState, kSize> gain;
};

}  // namespace spindrift
