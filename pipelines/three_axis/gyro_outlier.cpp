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

GyroDeviation deviation(const Vector3d& before_rad_s, const Vector3d& at_rad_s,
                        const Vector3d& behind_rad_s, const Vector3d& change_rad_s,
                        double noise_rad_s) {
  const Vector3d above = at_rad_s - before_rad_s.cwiseMax(behind_rad_s);
  const Vector3d below = before_rad_s.cwiseMin(behind_rad_s) - at_rad_s;
  return {.off_rad_s = (above.cwiseMax(below) - change_rad_s).maxCoeff(),
          .limit_rad_s = kContradictionSigmas * std::numbers::sqrt2 * noise_rad_s};
}

GyroDeviation deviation_at_end(const GyroSample& at, const GyroSample& next,
                               const GyroSample& next_but_one, double noise_rad_s) {
  const double share = seconds_between(at.t, next.t) / seconds_between(next.t, next_but_one.t);
  const Vector3d change = share * (next.rate_body_rad_s - next_but_one.rate_body_rad_s);
  const Vector3d off = (at.rate_body_rad_s - next.rate_body_rad_s - change).cwiseAbs();
  return {.off_rad_s = (off - change.cwiseAbs()).maxCoeff(),
          .limit_rad_s = kContradictionSigmas * noise_rad_s *
                         std::sqrt(1.0 + (1.0 + share) * (1.0 + share) + share * share)};
}

}  // namespace spindrift
