#include "pipelines/ephemeris/earth_pole.h"

#include <erfa.h>
#include <erfam.h>

namespace spindrift {

Eigen::Vector3d earth_pole_icrf(TaiTime t) {
  constexpr double kTaiEpoch_jd = 2440587.5;
  const double tt_s = seconds_between(TaiTime{}, t) + ERFA_TTMTAI;
  double of_date_from_icrf[3][3];  // NOLINT(*-avoid-c-arrays): ERFA's own type.
  eraPmat06(kTaiEpoch_jd, tt_s / ERFA_DAYSEC, of_date_from_icrf);
  return Eigen::Map<const Eigen::Vector3d>{&of_date_from_icrf[2][0]};
}

}  // namespace spindrift
