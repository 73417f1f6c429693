#include "pipelines/three_axis/sensor_errors.h"

#include <algorithm>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A sensor that is turned, or stamped too late, measures the attitude before that turn.
TurnPerError mounted(int mounting, int time_tag, const Vector3d& rate_body_rad_s) {
  TurnPerError per_error = TurnPerError::Zero();
  per_error.middleCols<3>(mounting) = -Matrix3d::Identity();
  per_error.col(time_tag) = -rate_body_rad_s;
  return per_error;
}

}  // namespace

TurnPerError star_per_error(const Vector3d& rate_body_rad_s) {
  return mounted(StarTrackerError, StarTrackerTimeError, rate_body_rad_s);
}

TurnPerError direction_per_error(SampleKind kind, const Vector3d& true_body,
                                 const Vector3d& rate_body_rad_s) {
  if (kind != SampleKind::Magnetometer) {
    return mounted(SunSensorError, SunSensorTimeError, rate_body_rad_s);
  }
  TurnPerError per_error = mounted(MagnetometerError, MagnetometerTimeError, rate_body_rad_s);
  per_error.middleCols<3>(MagnetometerBiasError) =
      -cross_matrix(true_body) / true_body.squaredNorm();
  return per_error;
}

TurnPerError turned(const TurnPerError& per_error, const Vector3d& turned_rad, const Matrix3d& back,
                    const Matrix3d& jacobian) {
  TurnPerError after = back * per_error;
  for (int axis = 0; axis < 3; ++axis) {
    after.col(GyroScaleError + axis) -= jacobian.col(axis) * turned_rad[axis];
    const int next = (axis + 1) % 3;
    const int last = (axis + 2) % 3;
    // The axis errors of a row of the gyro's matrix stand in the order of the axes.
    const int row = GyroAxisError + 2 * axis;
    after.col(row) -= jacobian.col(axis) * turned_rad[std::min(next, last)];
    after.col(row + 1) -= jacobian.col(axis) * turned_rad[std::max(next, last)];
  }
  return after;
}

}  // namespace spindrift
