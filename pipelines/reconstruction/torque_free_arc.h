/// @file
/// Integrates torque-free rigid-body motion, forwards or backwards, with its derivatives.
///
///     dq/dt = 1/2 q (w, 0),    I dw/dt = -w x I w
///
/// Fourth-order Runge-Kutta with steps of 0.01 rad keeps the error below 1e-9 of the turn.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/frames/body_state.h"

namespace spindrift {

/// Rows: small rotation about body axes, rate. Columns: both at the start, relative changes of the
/// principal moments of inertia in rising order, constant angular acceleration, body axes.
using ArcSlopes = Eigen::Matrix<double, 6, 12>;

struct ArcState {
  BodyState body;
  ArcSlopes slopes;
};

/// Longest turn of an arc, which takes about one second to compute.
inline constexpr double kLongestArc_rad = 1e4;

ArcState start_of_arc(const BodyState& body);

/// Continues an arc; the derivatives remain those with respect to its start.
/// @param inertia_kg_m2 Symmetric, positive definite; empty for a constant rate.
/// @param duration_s Negative for backwards.
ArcState torque_free_arc(const ArcState& from, const std::optional<Eigen::Matrix3d>& inertia_kg_m2,
                         double duration_s);

struct ArcCovariance {
  Eigen::Matrix<double, 6, 6> start;    ///< Covariance of rotation and rate.
  double inertia_fraction;              ///< Relative sigma of each principal moment.
  Eigen::Vector3d acceleration_rad_s2;  ///< Sigma of a constant one, per axis.
};

/// Returns the sigma per axis of the acceleration by a body's own motion if its inertia is unknown.
/// As no moment exceeds the sum of the others, it is bounded by the product of the other two rates.
Eigen::Vector3d unknown_acceleration_rad_s2(const Eigen::Vector3d& rate_body_rad_s);

/// Returns the covariance of rotation and rate at the end of the arc.
Eigen::Matrix<double, 6, 6> covariance_of(const ArcSlopes& slopes, const ArcCovariance& errors);

}  // namespace spindrift
