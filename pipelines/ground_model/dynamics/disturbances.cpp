#include "pipelines/ground_model/dynamics/disturbances.h"

#include <cmath>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

constexpr double kM_per_km = 1000.0;
constexpr double kTesla_per_nT = 1e-9;

double density_kg_m3(const Atmosphere& air, double altitude_km) {
  return air.density_kg_m3 * std::exp((air.altitude_km - altitude_km) / air.scale_height_km);
}

Vector3d force_icrf_n(const Drag& drag, const OrbitState& spacecraft) {
  const Vector3d wind_icrf_km_s =
      wgs84::kTurning_rad_s * Vector3d::UnitZ().cross(spacecraft.position_icrf_km) -
      spacecraft.velocity_icrf_km_s;
  const Vector3d wind_icrf_m_s = kM_per_km * wind_icrf_km_s;
  const double altitude_km = spacecraft.position_icrf_km.norm() - wgs84::kEquatorialRadius_km;
  return 0.5 * density_kg_m3(drag.atmosphere, altitude_km) * drag.area_m2 * drag.coefficient *
         wind_icrf_m_s.norm() * wind_icrf_m_s;
}

}  // namespace

Vector3d gravity_gradient_nm(const Eigen::Matrix3d& inertia_kg_m2, const Vector3d& place_body_km) {
  const double range_km = place_body_km.norm();
  const Vector3d up = place_body_km / range_km;
  return 3.0 * kEarthMu_km3_s2 / (range_km * range_km * range_km) * up.cross(inertia_kg_m2 * up);
}

Vector3d disturbance_body_nm(const Disturbances& disturbances, const Eigen::Matrix3d& inertia_kg_m2,
                             const Surroundings& surroundings,
                             const Eigen::Quaterniond& q_icrf_body, double t_s) {
  const PeriodicTorque& periodic = disturbances.periodic;
  const Eigen::Matrix3d R_body_icrf = q_icrf_body.toRotationMatrix().transpose();
  Vector3d torque_nm =
      disturbances.constant_body_nm +
      std::sin(periodic.rate_rad_s * t_s + periodic.phase_rad) * periodic.amplitude_body_nm +
      disturbances.dipole_body_a_m2.cross(kTesla_per_nT *
                                          (R_body_icrf * surroundings.field_icrf_nt));
  if (disturbances.gravity_gradient) {
    torque_nm +=
        gravity_gradient_nm(inertia_kg_m2, R_body_icrf * surroundings.spacecraft.position_icrf_km);
  }
  if (const auto& drag = disturbances.drag) {
    torque_nm += drag->centre_of_pressure_body_m.cross(
        R_body_icrf * force_icrf_n(*drag, surroundings.spacecraft));
  }
  return torque_nm;
}

}  // namespace spindrift
