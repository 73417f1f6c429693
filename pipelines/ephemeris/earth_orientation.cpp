#include "pipelines/ephemeris/earth_orientation.h"

#include <erfa.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <vector>

#include "pipelines/ephemeris/terrestrial_time.h"
#include "pipelines/frames/wgs84.h"
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

Eigen::Quaterniond TurningEarth::orientation(TaiTime t) {
  const auto hour = std::chrono::floor<std::chrono::hours>(t);
  if (hour_ != hour.time_since_epoch().count()) {
    q_icrf_at_hour_ = earth_orientation(hour);
    hour_ = hour.time_since_epoch().count();
  }
  return q_icrf_at_hour_ * Eigen::AngleAxisd{wgs84::kTurning_rad_s * seconds_between(hour, t),
                                             Eigen::Vector3d::UnitZ()};
}

Eigen::Vector3d earth_pole_icrf(TaiTime t) {
  double of_date_from_icrf[3][3];  // NOLINT(*-avoid-c-arrays): ERFA's own type.
  eraPmat06(kTaiEpoch_jd, tt_days(t), of_date_from_icrf);
  return Eigen::Map<const Eigen::Vector3d>{&of_date_from_icrf[2][0]};
}

}  // namespace spindrift
