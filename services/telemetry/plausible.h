/// @file
/// Plausibility checks for vectors and quaternions of telemetry.

#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <string_view>

#include "pipelines/three_axis/samples.h"

namespace spindrift {

/// Returns for example "sx, sy, sz = 0.1, 0, 2: must ..."
inline std::string impossible(std::string_view names,
                              const Eigen::Ref<const Eigen::VectorXd>& values,
                              std::string_view allowed) {
  std::string text;
  for (const double value : values) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  }
  return fmt::format("{} = {}: must {}", names, text, allowed);
}

/// Returns the end of a reason for a value that is a thousand times as large as it may be.
/// @param fits Whether a thousandth of the value were possible. @param unit Unit that the value has
///        then.
inline std::string likely_unit(bool fits, std::string_view unit) {
  return fits ? fmt::format("; looks like {}", unit) : std::string{};
}

/// Like the two checks below, written so that NaN fails.
inline bool is_unit(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::abs(values.norm() - 1.0) <= kUnitTolerance;
}
inline bool is_at_most(const Eigen::Vector3d& vector, double longest) {
  return vector.norm() <= longest;
}
inline bool is_between(const Eigen::Vector3d& vector, double shortest, double longest) {
  return vector.norm() >= shortest && vector.norm() <= longest;
}

}  // namespace spindrift
