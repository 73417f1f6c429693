/// @file
/// By how much the rate of a body wanders where nobody measures it.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/time/tai_time.h"

namespace spindrift {

class RateWander {
 public:
  explicit RateWander(double noise_rad_s) : noise_rad_s_{noise_rad_s} {}

  /// A measurement; times go one way, forwards or backwards.
  void note(TaiTime t, const Eigen::Vector3d& rate_rad_s);

  /// Spectral density of the rate's change, of each axis, rad^2/s^3, as it changes from second to
  /// second beyond the noise, of late; at least 1 deg in a minute.
  double rad2_s3() const;

 private:
  struct Rate {
    TaiTime t;
    Eigen::Vector3d rad_s;
  };
  double noise_rad_s_;
  std::optional<Rate> a_second_ago_;
  double rad2_s3_ = 0.0;  ///< Less the noise; may be below zero by chance.
};

}  // namespace spindrift
