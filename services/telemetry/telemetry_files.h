/// @file
/// Finds the telemetry files among what a person names, and what each of them holds.

#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/telemetry/telemetry_layout.h"

namespace spindrift {

struct TelemetryFile {
  std::filesystem::path path;
  std::optional<TelemetryKind> kind;  ///< None: the file is empty, without even a header.
  /// As what it is the source of its samples: its name, behind as much of its path as tells it from
  /// the others.
  std::string source = {};
};

/// The source among `files` that a person calls `name`: by its path as it was given, or any end of
/// that which no other one has. Empty: none, or several.
std::string find_source(std::span<const TelemetryFile> files, const std::string& name);

/// Every path is a CSV file or a directory, which means every *.csv in it, by name. In the order
/// given.
/// @return InvalidConfiguration with every path that cannot be read, every directory without
///         telemetry and every header that is none, one a line.
Expected<std::vector<TelemetryFile>> scan_telemetry(std::span<const std::filesystem::path> paths);

}  // namespace spindrift
