/// @file
/// The motion of a body that spins, as its sensors' edges are looked for in it: told as a
/// SpinMotion tells it, whatever turns the body.
///
/// The frame `axes` stands still: east and north of the axis (`tangent_basis`), and the axis, which
/// is that of the angular momentum at the start. What the sensors' frame does in it is split into a
/// turn about the third axis, the azimuth, and the least turn that tips the third axis where it is.

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
  /// @param q_body_sensors The third axis of the sensors' frame is what they are mounted about, the
  ///        first that of slit 1.
  /// @return InvalidConfiguration where the body turns by more than kMostTurn_rad in a step at the
  ///         start, or the third axis comes to lean away from `axes` by a quarter turn.
  static Expected<BodySpin> make(BodyMotion motion, const Eigen::Quaterniond& q_body_sensors);

  Eigen::Vector3d axis_icrf;  ///< Unit length.

  /// Of slit 1, not wrapped.
  double azimuth_rad(double t_s) const;
  /// Of the azimuth, mean of a step.
  double rate_at_rad_s(double t_s) const;
  /// R_axes_sensors = R_axes_tipped Rz(azimuth)
  Eigen::Matrix3d R_axes_tipped(double t_s) const;
  double end_s() const { return motion_.end_s(); }

 private:
  BodySpin(BodyMotion&& motion, Eigen::Quaterniond q_body_sensors);

  std::size_t step_at(double t_s) const;
  Eigen::Quaterniond q_axes_sensors(double t_s) const;

  BodyMotion motion_;
  Eigen::Quaterniond q_axes_icrf_;
  Eigen::Quaterniond q_body_sensors_;
  std::vector<double> azimuths_rad_;  ///< At the start of each step, and at the end.
};

}  // namespace spindrift
