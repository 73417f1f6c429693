/// @file
/// From where on a condition is worth an alert. The defaults are those of
/// schemas/mission.schema.toml.

#pragma once

#include <Eigen/Core>
#include <optional>

namespace spindrift {

/// A share of the last revolutions.
struct ShareLimit {
  double percent;
  int revolutions;
};

struct AlertLimits {
  int silent_revolutions = 10;
  ShareLimit period = {.percent = 10.0, .revolutions = 100};
  ShareLimit rejection = {.percent = 20.0, .revolutions = 100};
  double ambiguous_s = 60.0;
  double doubtful_s = 30.0;
  double sigma_deg = 1.0;
  double sigma_after_s = 120.0;
  double disagree_sigmas = 5.0;
  double off_target_deg = 2.0;
  double off_target_sigmas = 3.0;
  double nutation_deg = 0.5;
  double launcher_percent = 99.0;
};

/// Where axis and rate of a spinner should be.
struct SpinTarget {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  struct Rate {
    double rad_s;
    double tolerance_rad_s;
  };
  std::optional<Rate> rate = {};
};

}  // namespace spindrift
