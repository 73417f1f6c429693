/// @file
/// What the mission file of a three-axis spacecraft may be off by: parameters b that one pass
/// cannot check, with their prior covariance B (total covariance: P = P_noise + S B S').

#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "pipelines/frames/angle.h"

namespace spindrift {

/// First index of each group of errors. A sensor's mounting error turns what it measures, in body
/// axes: v_measured = exp([b]x) v_true. The gyro measures (1 + M) rate_true + bias, with the scale
/// errors on the diagonal of M. A positive time tag error stamps the sample too late.
enum AttitudeAlignmentError {
  StarTrackerError = 0,        ///< rad, about body x, y, z.
  SunSensorError = 3,          ///< rad, about body x, y, z.
  MagnetometerError = 6,       ///< rad, about body x, y, z.
  MagnetometerBiasError = 9,   ///< nT, along body x, y, z.
  GyroScaleError = 12,         ///< Diagonal of M.
  GyroAxisError = 15,          ///< rad, M at xy, xz, yx, yz, zx, zy.
  StarTrackerTimeError = 21,   ///< s against the gyro.
  SunSensorTimeError = 22,     ///< s
  MagnetometerTimeError = 23,  ///< s
  InertiaError = 24,           ///< Relative error of the three principal moments, ascending.
};
inline constexpr int kAttitudeAlignmentErrors = 27;

/// Prior covariance of the errors in their units; zero where the file counts as exact.
using AttitudeAlignment = Eigen::Matrix<double, kAttitudeAlignmentErrors, kAttitudeAlignmentErrors>;

/// Holds the name of an error in [calibration] of the mission file, and one unit of the name in the
/// unit of the error.
struct AttitudeAlignmentName {
  std::string_view name;
  double unit;
};

/// Names in the order of AttitudeAlignmentError.
inline constexpr std::array<AttitudeAlignmentName, kAttitudeAlignmentErrors>
    kAttitudeAlignmentNames{{
        {"star_tracker_x_deg", kRadPerDeg},
        {"star_tracker_y_deg", kRadPerDeg},
        {"star_tracker_z_deg", kRadPerDeg},
        {"sun_sensor_x_deg", kRadPerDeg},
        {"sun_sensor_y_deg", kRadPerDeg},
        {"sun_sensor_z_deg", kRadPerDeg},
        {"magnetometer_x_deg", kRadPerDeg},
        {"magnetometer_y_deg", kRadPerDeg},
        {"magnetometer_z_deg", kRadPerDeg},
        {"magnetometer_bias_x_nt", 1.0},
        {"magnetometer_bias_y_nt", 1.0},
        {"magnetometer_bias_z_nt", 1.0},
        {"gyro_scale_x", 1.0},
        {"gyro_scale_y", 1.0},
        {"gyro_scale_z", 1.0},
        {"gyro_xy_deg", kRadPerDeg},
        {"gyro_xz_deg", kRadPerDeg},
        {"gyro_yx_deg", kRadPerDeg},
        {"gyro_yz_deg", kRadPerDeg},
        {"gyro_zx_deg", kRadPerDeg},
        {"gyro_zy_deg", kRadPerDeg},
        {"star_tracker_time_tag_s", 1.0},
        {"sun_sensor_time_tag_s", 1.0},
        {"magnetometer_time_tag_s", 1.0},
        {"inertia_x_fraction", 1.0},
        {"inertia_y_fraction", 1.0},
        {"inertia_z_fraction", 1.0},
    }};

}  // namespace spindrift
