/// @file
/// Disturbance torques of the space environment on a body.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "pipelines/ephemeris/orbit_state.h"

namespace spindrift {

/// Exponential atmosphere: density exp(-(h - altitude) / scale height), h above the equatorial
/// radius. The density is uniform where the scale height is infinite.
struct Atmosphere {
  double density_kg_m3;
  double altitude_km = 0.0;
  double scale_height_km = std::numeric_limits<double>::infinity();
};

/// Drag against the air, which rotates with the Earth. It acts at one point whatever the attitude.
struct Drag {
  Atmosphere atmosphere;
  double area_m2;
  double coefficient;
  Eigen::Vector3d centre_of_pressure_body_m;  ///< Position relative to the centre of mass.
};

/// Torque of the form amplitude sin(rate t + phase), body axes.
struct PeriodicTorque {
  Eigen::Vector3d amplitude_body_nm = Eigen::Vector3d::Zero();
  double rate_rad_s = 0.0;  ///< Usually the orbital rate.
  double phase_rad = 0.0;
};

struct Disturbances {
  bool gravity_gradient = false;
  std::optional<Drag> drag = std::nullopt;
  Eigen::Vector3d dipole_body_a_m2 = Eigen::Vector3d::Zero();  ///< Residual magnetic dipole.
  Eigen::Vector3d constant_body_nm = Eigen::Vector3d::Zero();
  PeriodicTorque periodic = {};
};

inline bool disturbs(const Disturbances& disturbances) {
  return disturbances.gravity_gradient || disturbances.drag ||
         !disturbances.dipole_body_a_m2.isZero(0.0) || !disturbances.constant_body_nm.isZero(0.0) ||
         !disturbances.periodic.amplitude_body_nm.isZero(0.0);
}

/// Position, velocity and magnetic field at the body, taken as constant over a control period.
struct Surroundings {
  OrbitState spacecraft = {.position_icrf_km = Eigen::Vector3d::Zero(),
                           .velocity_icrf_km_s = Eigen::Vector3d::Zero()};
  Eigen::Vector3d field_icrf_nt = Eigen::Vector3d::Zero();
};

/// Returns the torque of the Earth's gravity, body axes.
/// @param place_body_km Position from the Earth's centre, body axes; not zero.
Eigen::Vector3d gravity_gradient_nm(const Eigen::Matrix3d& inertia_kg_m2,
                                    const Eigen::Vector3d& place_body_km);

/// @param surroundings The position must not be zero with gravity gradient or drag.
Eigen::Vector3d disturbance_body_nm(const Disturbances& disturbances,
                                    const Eigen::Matrix3d& inertia_kg_m2,
                                    const Surroundings& surroundings,
                                    const Eigen::Quaterniond& q_icrf_body, double t_s);

}  // namespace spindrift
