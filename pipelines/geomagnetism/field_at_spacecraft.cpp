#include "pipelines/geomagnetism/field_at_spacecraft.h"

namespace spindrift {

Expected<Eigen::Vector3d> field_icrf_nt(const MainFieldModel& model, TaiTime t,
                                        const Eigen::Vector3d& position_icrf_km,
                                        TurningEarth& earth) {
  const Eigen::Quaterniond q_icrf_itrf = earth.orientation(t);
  return model.at(decimal_year(t))
      .and_then([&](const MainField& field) {
        return field.at(q_icrf_itrf.conjugate() * position_icrf_km);
      })
      .map([&](const Eigen::Vector3d& field_itrf_nt) -> Eigen::Vector3d {
        return q_icrf_itrf * field_itrf_nt;
      });
}

}  // namespace spindrift
