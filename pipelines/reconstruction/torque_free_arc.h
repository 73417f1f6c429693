/// @file
/// A rigid body without torques, forwards or backwards, and what every error of its start becomes.
///
///     dq/dt = 1/2 q (w, 0),    I dw/dt = -w x I w
///
/// Runge-Kutta of fourth order, a hundredth of a radian a step: within 1e-9 of the angle turned.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/frames/body_state.h"

namespace spindrift {

/// Rows: small rotation about body axes, rate. Columns: the same at the start, then parts of the
/// principal moments of inertia, in rising order, then an even angular acceleration, body axes.
using ArcSlopes = Eigen::Matrix<double, 6, 12>;

struct ArcState {
  BodyState body;
  ArcSlopes slopes;
};

/// No arc may turn by more: a second of computing.
inline constexpr double kLongestArc_rad = 1e4;

ArcState start_of_arc(const BodyState& body);

/// On from where an arc has come to, its slopes still those by its start.
/// @param inertia_kg_m2 Symmetric, positive definite; empty: the rate is constant.
/// @param duration_s Negative: backwards.
ArcState torque_free_arc(const ArcState& from, const std::optional<Eigen::Matrix3d>& inertia_kg_m2,
                         double duration_s);

struct ArcCovariance {
  Eigen::Matrix<double, 6, 6> start;    ///< Rotation and rate.
  double inertia_fraction;              ///< One standard deviation of each principal moment.
  Eigen::Vector3d acceleration_rad_s2;  ///< One standard deviation of an even one, of each axis.
};

/// One standard deviation of the acceleration that a body of unknown moments gives itself, of each
/// axis: a moment is at most the sum of the others, so that it lies anywhere within the product of
/// the rates about the other axes.
Eigen::Vector3d unknown_acceleration_rad_s2(const Eigen::Vector3d& rate_body_rad_s);

/// Of rotation and rate at the end.
Eigen::Matrix<double, 6, 6> covariance_of(const ArcSlopes& slopes, const ArcCovariance& errors);

}  // namespace spindrift
