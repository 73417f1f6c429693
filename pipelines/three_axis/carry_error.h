/// @file
/// The error that propagation with the gyro adds to a direction or an attitude.

#pragma once

namespace spindrift {

/// Holds the propagation error about each axis, with variance `variance_rad2()`.
struct CarryError {
  double noise_rad2 = 0.0;  ///< Variance of independent errors, which adds up.
  double drift_rad = 0.0;   ///< Drift by the unknown bias, whose turns add up linearly.

  void add(const CarryError& more) {
    noise_rad2 += more.noise_rad2;
    drift_rad += more.drift_rad;
  }
  double variance_rad2() const { return noise_rad2 + drift_rad * drift_rad; }
};

}  // namespace spindrift
