#include "pipelines/geomagnetism/tables/revolution_field.h"

#include "pipelines/ephemeris/flight_frames.h"

namespace spindrift {

Expected<Eigen::Vector3d> field_orbit_nt(const MainField& field, const OrbitState& spacecraft,
                                         const Eigen::Quaterniond& q_icrf_itrf) {
  return orbit_frame(spacecraft).and_then([&](const Eigen::Quaterniond& q_icrf_orbit) {
    return field.at(q_icrf_itrf.conjugate() * spacecraft.position_icrf_km)
        .map([&](const Eigen::Vector3d& field_itrf_nt) -> Eigen::Vector3d {
          return q_icrf_orbit.conjugate() * (q_icrf_itrf * field_itrf_nt);
        });
  });
}

Expected<Eigen::Vector3d> RevolutionField::at(double behind_first_rad) {
  const TaiTime t = orbit_.when_behind_epoch(behind_first_rad);
  return orbit_.at(t).and_then([&](const OrbitState& spacecraft) {
    return field_orbit_nt(field_, spacecraft, earth_.orientation(t));
  });
}

}  // namespace spindrift
