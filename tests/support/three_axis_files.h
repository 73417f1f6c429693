/// @file
/// A pass of a three-axis spacecraft as files, with a little of everything that samples are left
/// out for.

#pragma once

#include <cstdint>
#include <filesystem>

namespace spindrift::testing {

struct ThreeAxisScene {
  double duration_s = 60.0;
  double gyro_s = 0.1;  ///< Between samples; likewise:
  double star_s = 1.0;
  double sun_s = 0.5;       ///< Of the magnetometer, too.
  bool separation = false;  ///< The mission says that it separated 60 s before the first sample.
};

/// mission.toml of a spacecraft "SAT" without an orbit, and a CSV file of each kind. It turns
/// smoothly; one gyro sample is saturated, one star fix is of another attitude.
void write_three_axis_pass(const std::filesystem::path& folder, const ThreeAxisScene& scene = {});

/// Of the CSV files of a pass the rows of one half of its time.
void write_half(const std::filesystem::path& pass, std::int64_t middle_tai_ns, bool first,
                const std::filesystem::path& to);

}  // namespace spindrift::testing
