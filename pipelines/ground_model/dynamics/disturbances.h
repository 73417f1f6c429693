/// @file
/// Torques of the surroundings on a body.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "pipelines/ephemeris/orbit_state.h"

namespace spindrift {

/// density exp(-(h - altitude) / scale height), h above the equatorial radius; even where the
/// scale height is infinite.
struct Atmosphere {
  double density_kg_m3;
  double altitude_km = 0.0;
  double scale_height_km = std::numeric_limits<double>::infinity();
};

/// A drag against the air, which turns with the Earth, that takes hold at one point of the body
/// and has the same size whatever side the body shows.
struct Drag {
  Atmosphere atmosphere;
  double area_m2;
  double coefficient;
  Eigen::Vector3d centre_of_pressure_body_m;  ///< From the centre of mass.
};

/// amplitude sin(rate t + phase)
struct PeriodicTorque {
  Eigen::Vector3d amplitude_body_nm = Eigen::Vector3d::Zero();
  double rate_rad_s = 0.0;  ///< Of the orbit, mostly.
  double phase_rad = 0.0;
};

struct Disturbances {
  bool gravity_gradient = false;
  std::optional<Drag> drag = std::nullopt;
  Eigen::Vector3d dipole_body_a_m2 = Eigen::Vector3d::Zero();  ///< Residual.
  Eigen::Vector3d constant_body_nm = Eigen::Vector3d::Zero();
  PeriodicTorque periodic = {};
};

/// Any torque at all.
inline bool disturbs(const Disturbances& disturbances) {
  return disturbances.gravity_gradient || disturbances.drag ||
         !disturbances.dipole_body_a_m2.isZero(0.0) || !disturbances.constant_body_nm.isZero(0.0) ||
         !disturbances.periodic.amplitude_body_nm.isZero(0.0);
}

/// Where the body is: of a control period, in which it hardly changes.
struct Surroundings {
  OrbitState spacecraft = {.position_icrf_km = Eigen::Vector3d::Zero(),
                           .velocity_icrf_km_s = Eigen::Vector3d::Zero()};
  Eigen::Vector3d field_icrf_nt = Eigen::Vector3d::Zero();
};

/// @param surroundings Off the Earth's centre where there is gravity gradient or drag.
Eigen::Vector3d disturbance_body_nm(const Disturbances& disturbances,
                                    const Eigen::Matrix3d& inertia_kg_m2,
                                    const Surroundings& surroundings,
                                    const Eigen::Quaterniond& q_icrf_body, double t_s);

}  // namespace spindrift
