/// @file
/// What a telemetry file holds; its header line tells.

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/telemetry_files/csv.h"

namespace spindrift {

enum class TelemetryKind { Pulses, Coded, Gyro, Star, Sun, Magnetometer };
std::string_view name_of(TelemetryKind kind);

/// The columns of one file.
// Written as a whole, never default-constructed.
struct TelemetryLayout {
  TelemetryKind kind;
  std::size_t columns;                           ///< With `spacecraft`, where there is one.
  std::optional<std::size_t> spacecraft_column;  ///< From 0.
};

struct OpenTelemetry {
  CsvLines lines;  ///< Those behind the header.
  TelemetryLayout layout;
};

/// Opens a file and reads its header line, the first that is not empty.
/// @return InvalidConfiguration with path and line for what is not a readable file, no header or
///         one that is not known, saying which there are; Unavailable when reading fails.
Expected<OpenTelemetry> open_telemetry(const std::filesystem::path& path);

}  // namespace spindrift
