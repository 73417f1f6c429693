/// @file
/// How errors of the mission file act on an attitude and on what the sensors measure.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/three_axis/alignment.h"
#include "pipelines/three_axis/attitude_from_vectors.h"
#include "pipelines/three_axis/sample_kind.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Number of errors that act on a filter: all but those of the inertia.
inline constexpr int kFilterErrors = InertiaError;
using FilterAlignment = Eigen::Matrix<double, kFilterErrors, kFilterErrors>;

/// Derivative of a small turn, body axes, by the errors.
using TurnPerError = Eigen::Matrix<double, 3, kFilterErrors>;

/// An attitude whose covariance is that of its noise, and what the errors do to it.
struct SensitiveAttitude : UncertainAttitude {
  /// Derivative of the turn from this attitude to the true one.
  TurnPerError per_error = TurnPerError::Zero();
};

/// Holds a direction measured by one sensor and its reference in ICRF.
struct SeenDirection {
  TaiTime t;
  SampleKind kind;
  ObservedDirection direction;  ///< The magnetometer's reference is in nT.
  /// How far the measured field strength exceeds the model, in standard deviations; tested together
  /// with the direction. Empty for sensors other than the magnetometer.
  std::optional<double> stronger = std::nullopt;
};

/// @name Derivative of a measured turn
/// Returns how the turn from the expected attitude to the measured one depends on the errors; of a
/// direction only the turns across it count.
/// @{
TurnPerError star_per_error(const Eigen::Vector3d& rate_body_rad_s);
/// @param true_body The direction, of a field in nT. A measured one has the noise of the turn that
///        it gives, and innovations would seem to show errors along the direction.
TurnPerError direction_per_error(SampleKind kind, const Eigen::Vector3d& true_body,
                                 const Eigen::Vector3d& rate_body_rad_s);
/// @}

/// Propagates the derivative of the turn from an attitude to the true one over a turn of the body,
/// whose rate the gyro measured with its errors of scale and axes.
/// @param back Rotation of components from the former into the new body axes.
/// @param jacobian Right Jacobian of `turned_rad`.
TurnPerError turned(const TurnPerError& per_error, const Eigen::Vector3d& turned_rad,
                    const Eigen::Matrix3d& back, const Eigen::Matrix3d& jacobian);

}  // namespace spindrift
