#include "pipelines/three_axis/products.h"

#include <cmath>

namespace spindrift {

std::string_view name_of(SampleKind kind) {
  static constexpr std::array<std::string_view, kSampleKinds> kNames = {
      "orbit_state", "gyro", "star", "sun", "magnetometer"};
  return kNames.at(index_of(kind));
}

std::string_view name_of(AttitudeSource source) {
  static constexpr std::array<std::string_view, 3> kNames = {"mekf", "batch", "sequential"};
  return kNames.at(static_cast<std::size_t>(source));
}

Observation observation_of(const RejectedSample& gyro) {
  const FailedTest failed = gyro.failed.value();
  return {.t = gyro.t,
          .source = source_of(gyro.kind),
          .residual = {.freedom = 1, .value = failed.value * Eigen::Vector3d::UnitX()},
          .limit = failed.limit,
          .rejected_by = gyro.rejected_by};
}

double AttitudeEstimate::sigma_rad() const { return std::sqrt(covariance_rad2.trace()); }

}  // namespace spindrift
