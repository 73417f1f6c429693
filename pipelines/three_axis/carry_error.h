/// @file
/// What a direction or an attitude loses in being carried along with the gyro.

#pragma once

namespace spindrift {

/// About each axis; one standard deviation is the root of `variance_rad2()`.
struct CarryError {
  double noise_rad2 = 0.0;  ///< Of independent errors: their variances add.
  double drift_rad = 0.0;   ///< Of the bias, unknown: its turns add.

  void add(const CarryError& more) {
    noise_rad2 += more.noise_rad2;
    drift_rad += more.drift_rad;
  }
  double variance_rad2() const { return noise_rad2 + drift_rad * drift_rad; }
};

}  // namespace spindrift
