#include "pipelines/ephemeris/earth_pole.h"

#include <erfa.h>

#include "pipelines/ephemeris/terrestrial_time.h"

namespace spindrift {

Eigen::Vector3d earth_pole_icrf(TaiTime t) {
  double of_date_from_icrf[3][3];  // NOLINT(*-avoid-c-arrays): ERFA's own type.
  eraPmat06(kTaiEpoch_jd, tt_days(t), of_date_from_icrf);
  return Eigen::Map<const Eigen::Vector3d>{&of_date_from_icrf[2][0]};
}

}  // namespace spindrift
