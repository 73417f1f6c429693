#include "pipelines/three_axis/gyro_outlier.h"

#include <cmath>
#include <numbers>

#include "pipelines/statistics/significance.h"

namespace spindrift {

using Eigen::Vector3d;

Vector3d change_rad_s(const GyroSample& a, const GyroSample& b, TaiTime from, TaiTime t) {
  const double share = seconds_between(from, t) / seconds_between(a.t, b.t);
  return (share * (b.rate_body_rad_s - a.rate_body_rad_s)).cwiseAbs();
}

bool stands_out(const Vector3d& before_rad_s, const Vector3d& at_rad_s,
                const Vector3d& behind_rad_s, const Vector3d& change_rad_s, double noise_rad_s) {
  const Vector3d above = at_rad_s - before_rad_s.cwiseMax(behind_rad_s);
  const Vector3d below = before_rad_s.cwiseMin(behind_rad_s) - at_rad_s;
  const double by_noise_rad_s = kContradictionSigmas * std::numbers::sqrt2 * noise_rad_s;
  return ((above.cwiseMax(below) - change_rad_s).array() > by_noise_rad_s).any();
}

bool end_stands_out(const GyroSample& at, const GyroSample& next, const GyroSample& next_but_one,
                    double noise_rad_s) {
  const double share = seconds_between(at.t, next.t) / seconds_between(next.t, next_but_one.t);
  const Vector3d change = share * (next.rate_body_rad_s - next_but_one.rate_body_rad_s);
  const Vector3d off = (at.rate_body_rad_s - next.rate_body_rad_s - change).cwiseAbs();
  const double by_noise_rad_s = kContradictionSigmas * noise_rad_s *
                                std::sqrt(1.0 + (1.0 + share) * (1.0 + share) + share * share);
  return ((off - change.cwiseAbs()).array() > by_noise_rad_s).any();
}

}  // namespace spindrift
