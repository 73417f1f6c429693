/// @file
/// Estimates how much the rate of a body changes while it is not measured.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/time/tai_time.h"

namespace spindrift {

class RateWander {
 public:
  explicit RateWander(double noise_rad_s) : noise_rad_s_{noise_rad_s} {}

  /// Adds a measured rate. The times must be monotonic, either rising or falling.
  void track(TaiTime t, const Eigen::Vector3d& rate_rad_s);

  /// Returns the spectral density of the change of rate per axis, rad^2/s^3. It follows recent
  /// changes over one second, less the noise, with a floor equivalent to 1 deg in a minute.
  double rad2_s3() const;

 private:
  struct Rate {
    TaiTime t;
    Eigen::Vector3d rad_s;
  };
  double noise_rad_s_;
  std::optional<Rate> a_second_ago_;
  double rad2_s3_ = 0.0;  ///< Density with the noise subtracted; may be negative by chance.
};

}  // namespace spindrift
