#include "pipelines/geomagnetism/tables/revolution_field.h"

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/frames/angle.h"

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

Expected<double> RevolutionField::off_a_revolution_later_nt() {
  constexpr int kPlaces = 360;
  double sum_nt = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double behind_rad = kTurn_rad * i / kPlaces;
    const auto now_nt = at(behind_rad);
    const auto later_nt = at(behind_rad + kTurn_rad);
    if (!now_nt || !later_nt) {
      return Unexpected{now_nt ? later_nt.error() : now_nt.error()};
    }
    sum_nt += (*later_nt - *now_nt).norm();
  }
  return sum_nt / kPlaces;
}

}  // namespace spindrift
