/// @file
/// Adapts a BodyMotion to the interface of SpinMotion, so that SpinEdges finds edges in it.
///
/// The frame `axes` is inertially fixed: its first two axes point east and north of the spin axis
/// (`tangent_basis`), its third is the spin axis, the direction of the angular momentum at the
/// start. The rotation of the sensors' frame in it is split into a turn about the third axis, the
/// azimuth, and the smallest rotation that tips the third axis to where it is.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/body_motion.h"

namespace spindrift {

class BodySpin {
 public:
  /// @param q_body_sensors Attitude of the sensors' frame: the sensors are mounted about its third
  ///        axis, and its first axis points to slit 1.
  /// @return InvalidConfiguration where the body turns by more than kMostTurn_rad in a step at the
  ///         start, or the third axis comes to tilt by 90 deg or more from that of `axes`.
  static Expected<BodySpin> make(BodyMotion motion, const Eigen::Quaterniond& q_body_sensors);

  Eigen::Vector3d axis_icrf;  ///< Spin axis, unit vector, ICRF.

  /// Returns the azimuth of slit 1, not wrapped.
  double azimuth_rad(double t_s) const;
  /// Returns the rate of the azimuth, averaged over the step at `t_s`.
  double rate_at_rad_s(double t_s) const;
  /// Returns the tilt of the sensors' frame: R_axes_sensors = R_axes_tipped Rz(azimuth).
  Eigen::Matrix3d R_axes_tipped(double t_s) const;
  double end_s() const { return motion_.end_s(); }

 private:
  BodySpin(BodyMotion&& motion, Eigen::Quaterniond q_body_sensors);

  std::size_t step_at(double t_s) const;
  Eigen::Quaterniond q_axes_sensors(double t_s) const;

  BodyMotion motion_;
  Eigen::Quaterniond q_axes_icrf_;
  Eigen::Quaterniond q_body_sensors_;
  std::vector<double> azimuths_rad_;  ///< Azimuth at the start of each step and at the end.
};

}  // namespace spindrift
