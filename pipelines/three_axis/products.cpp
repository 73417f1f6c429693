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

double AttitudeEstimate::sigma_rad() const { return std::sqrt(covariance_rad2.trace()); }

}  // namespace spindrift
