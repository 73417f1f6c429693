#include "pipelines/three_axis/gyro_tests.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

/// Returns the absolute change of rate per axis from `from` to `t`, extrapolated from the change
/// between the adjacent samples `a` and `b`.
Vector3d change_rad_s(const GyroSample& a, const GyroSample& b, TaiTime from, TaiTime t) {
  const double share = elapsed_s(from, t) / elapsed_s(a.t, b.t);
  return (share * (b.rate_body_rad_s - a.rate_body_rad_s)).cwiseAbs();
}

}  // namespace

std::optional<RejectedSample> rejected_alone(const GyroSample& sample, const GyroSensor& sensor,
                                             const std::optional<FailedTest>& frozen) {
  RejectedSample rejected{
      .t = sample.t, .kind = SampleKind::Gyro, .rejected_by = Rejection::Frozen, .failed = frozen};
  if (sensor.range_rad_s) {
    const FailedTest range{.value = sample.rate_body_rad_s.cwiseAbs().maxCoeff(),
                           .limit = 0.999 * *sensor.range_rad_s};
    if (range.value >= range.limit) {
      rejected.rejected_by = Rejection::Saturated;
      rejected.failed = range;
    }
  }
  return rejected.failed ? std::optional{rejected} : std::nullopt;
}

RejectedSample outlier(const GyroSample& sample, const GyroDeviation& deviation) {
  return {.t = sample.t,
          .kind = SampleKind::Gyro,
          .rejected_by = Rejection::Outlier,
          .failed = FailedTest{deviation.off_rad_s, deviation.limit_rad_s}};
}

GyroDeviation deviation(std::span<const GyroSample> samples, std::size_t i, double noise_rad_s) {
  const GyroSample& before = samples[i - 1];
  const GyroSample& at = samples[i];
  const GyroSample& behind = samples[i + 1];
  Vector3d change = Vector3d::Constant(std::numeric_limits<double>::infinity());
  if (i > 1) {
    change = change_rad_s(samples[i - 2], before, before.t, at.t);
  }
  if (i + 2 < samples.size()) {
    change = change.cwiseMin(change_rad_s(behind, samples[i + 2], at.t, behind.t));
  }
  const Vector3d above =
      at.rate_body_rad_s - before.rate_body_rad_s.cwiseMax(behind.rate_body_rad_s);
  const Vector3d below =
      before.rate_body_rad_s.cwiseMin(behind.rate_body_rad_s) - at.rate_body_rad_s;
  return {.off_rad_s = (above.cwiseMax(below) - change).maxCoeff(),
          .limit_rad_s = kContradictionSigmas * std::numbers::sqrt2 * noise_rad_s};
}

GyroDeviation deviation_at_end(const GyroSample& at, const GyroSample& next,
                               const GyroSample& next_but_one, double noise_rad_s) {
  const OffLine line = off_line(at, next, next_but_one);
  return {.off_rad_s = (line.off_rad_s.cwiseAbs() - line.change_rad_s.cwiseAbs()).maxCoeff(),
          .limit_rad_s = kContradictionSigmas * noise_rad_s * line.spread};
}

OffLine off_line(const GyroSample& at, const GyroSample& next, const GyroSample& next_but_one) {
  const double share = elapsed_s(at.t, next.t) / elapsed_s(next.t, next_but_one.t);
  const Vector3d change = share * (next.rate_body_rad_s - next_but_one.rate_body_rad_s);
  return {.off_rad_s = at.rate_body_rad_s - next.rate_body_rad_s - change,
          .change_rad_s = change,
          .spread = std::sqrt(1.0 + (1.0 + share) * (1.0 + share) + share * share)};
}

}  // namespace spindrift
