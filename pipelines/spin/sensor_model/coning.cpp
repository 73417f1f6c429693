#include "pipelines/spin/sensor_model/coning.h"

#include <Eigen/Dense>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

/// Holds a direction of the body with the changes of its angle from the axis and of its azimuth,
/// which is counted as slit 1 turns.
struct Turned {
  Eigen::Vector3d direction;
  Eigen::RowVector2d polar_per_coning;
  Eigen::RowVector2d azimuth_per_coning;

  double polar_rad() const {
    return std::atan2(std::hypot(direction.x(), direction.y()), direction.z());
  }
  double azimuth_rad() const { return std::atan2(direction.y(), direction.x()); }
};

Turned turned(const Eigen::Vector3d& direction_sensors, const Eigen::Vector2d& coning_rad) {
  const Eigen::Vector3d vector_rad{coning_rad.x(), coning_rad.y(), 0.0};
  const Eigen::Vector3d direction = rotation_by(vector_rad) * direction_sensors;
  const double across = std::sqrt(direction.head<2>().squaredNorm());
  const Eigen::RowVector3d along{direction.x() / across, direction.y() / across, 0.0};
  const Eigen::RowVector3d hinge{-along.y(), along.x(), 0.0};
  const Eigen::Matrix<double, 3, 2> per_vector = rotation_per_vector(vector_rad).leftCols<2>();
  const double cotangent = direction.z() / across;
  return {.direction = direction,
          .polar_per_coning = hinge * per_vector,
          .azimuth_per_coning = (Eigen::RowVector3d::UnitZ() - cotangent * along) * per_vector};
}

}  // namespace

ConedSlit as_coned(const SunSensor& slit, const Eigen::Vector2d& coning_rad) {
  // The slit is represented by the normal of its plane.
  const double in_equator = std::cos(slit.slit_cant_rad);
  const Turned normal =
      turned({in_equator * std::sin(slit.slit_separation_rad),
              in_equator * std::cos(slit.slit_separation_rad), std::sin(slit.slit_cant_rad)},
             coning_rad);
  ConedSlit as_coned{.slit = slit,
                     .cant_per_coning = -normal.polar_per_coning,
                     .separation_per_coning = -normal.azimuth_per_coning};
  // Zero coning leaves the slit exactly unchanged.
  if (!coning_rad.isZero(0.0)) {
    as_coned.slit = {.slit_cant_rad = kQuarter_rad - normal.polar_rad(),
                     .slit_separation_rad = wrapped_rad(kQuarter_rad - normal.azimuth_rad())};
  }
  return as_coned;
}

ConedBeam as_coned(const InfraredSensor& beam, const Eigen::Vector2d& coning_rad) {
  const double across = std::sin(beam.mount_angle_rad);
  const Turned along =
      turned({across * std::cos(beam.azimuth_rad), -across * std::sin(beam.azimuth_rad),
              std::cos(beam.mount_angle_rad)},
             coning_rad);
  ConedBeam as_coned{.beam = beam,
                     .mount_angle_per_coning = along.polar_per_coning,
                     .azimuth_per_coning = -along.azimuth_per_coning};
  if (!coning_rad.isZero(0.0)) {
    as_coned.beam.mount_angle_rad = along.polar_rad();
    as_coned.beam.azimuth_rad = -along.azimuth_rad();
  }
  return as_coned;
}

ConingTest test_coning(const Eigen::Vector2d& coning_rad, const Eigen::Matrix2d& covariance_rad2) {
  const double hinge_rad = std::atan2(coning_rad.y(), coning_rad.x());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spectrum;
  spectrum.computeDirect(covariance_rad2);
  const Eigen::Vector2d along = spectrum.eigenvectors().transpose() * coning_rad;
  const double chi_square = along.cwiseAbs2().cwiseQuotient(spectrum.eigenvalues()).sum();
  return {.tilt_rad = coning_rad.norm(),
          // The axis leans a quarter turn behind its rotation vector; "behind" is clockwise.
          .azimuth_rad = wrapped_rad(kQuarter_rad - hinge_rad),
          .detected = chi_square > kFalseAlarmSquares,
          .detectable_rad = (std::sqrt(kFalseAlarmSquares) + kDetectionSigmas) *
                            std::sqrt(spectrum.eigenvalues()[1])};
}

}  // namespace spindrift
