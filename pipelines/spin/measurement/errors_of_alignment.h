/// @file
/// The model errors (types/model_allowance.h) that errors of the mission file make of measured
/// angles. Fixes and mean compare angles, and know their slopes by model errors; edges have exact
/// slopes of their own.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

/// Where an axis has the Sun and the Earth.
struct SeenByAxis {
  double sun_angle_rad;
  double earth_angle_rad;
  double disc_rad;  ///< Half-angle of the Earth's disc.
};

/// Returns how much larger the sun angle is measured per error of the mission file.
SpinAlignmentVector sun_angle_per_error(const SunSensor& slits, double sun_angle_rad);

using ErrorsOfAlignment = Eigen::Matrix<double, kModelErrors, kSpinAlignmentErrors>;

/// Returns the model errors per error of the mission file: the model's disc too large, the sun
/// angle measured too large, the beam's azimuth measured too large. A time tag makes none of them.
ErrorsOfAlignment errors_of_alignment(const SpinConfig& config, const SeenByAxis& seen);

}  // namespace spindrift
