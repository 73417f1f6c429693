#include "pipelines/ephemeris/earth_orientation.h"

#include <erfa.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "pipelines/ephemeris/terrestrial_time.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

int tai_minus_utc_s(TaiTime t) {
  const std::vector<LeapSecond> leaps = leap_seconds();
  const auto next =
      std::upper_bound(leaps.begin() + 1, leaps.end(), t,
                       [](TaiTime at, const LeapSecond& leap) { return at < leap.start; });
  return std::prev(next)->tai_minus_utc_s;
}

}  // namespace

Eigen::Quaterniond earth_orientation(TaiTime t) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const double ut_days = (seconds_between(TaiTime{}, t) - tai_minus_utc_s(t)) / ERFA_DAYSEC;
  double itrf_from_icrf[3][3];  // NOLINT(*-avoid-c-arrays): ERFA's own type.
  eraC2t06a(kTaiEpoch_jd, tt_days(t), kTaiEpoch_jd, ut_days, 0.0, 0.0, itrf_from_icrf);
  const Eigen::Matrix3d R_itrf_icrf = Eigen::Map<const RowMajor>{&itrf_from_icrf[0][0]};
  return Eigen::Quaterniond{R_itrf_icrf.transpose()};
}

}  // namespace spindrift
