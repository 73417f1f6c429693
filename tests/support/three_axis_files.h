/// @file
/// Writes a pass of a three-axis spacecraft as files that contain samples of each kind that is left
/// out.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace spindrift::testing {

struct ThreeAxisScene {
  double duration_s = 60.0;
  double gyro_s = 0.1;  ///< Interval of the gyro samples.
  double star_s = 1.0;
  double sun_s = 0.5;  ///< Interval of sun sensor and magnetometer.
  /// Whether the mission states a separation 60 s before the first sample.
  bool separation = false;
  /// Angle of the commanded attitude to that of the first sample, about x; none is stated without.
  std::optional<double> commanded_deg = {};
};

/// Writes mission.toml of a spacecraft "SAT" without an orbit and a CSV file of each kind. The body
/// rotates smoothly; one gyro sample is saturated and one star fix is wrong.
void write_three_axis_pass(const std::filesystem::path& folder, const ThreeAxisScene& scene = {});

/// Copies the rows of the first or second half of a pass's time span.
void write_half(const std::filesystem::path& pass, std::int64_t middle_tai_ns, bool first,
                const std::filesystem::path& to);

}  // namespace spindrift::testing
