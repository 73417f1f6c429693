/// @file
/// Finds telemetry files in the paths that a user gives, and determines their kinds.

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
  std::optional<TelemetryKind> kind;  ///< Empty when the file lacks even a header.
  /// Name of the file as the source of its samples, with as much of its path as makes it unique.
  std::string source = {};
};

/// Finds the source whose path, as given, or a unique ending of it, is `name`.
/// @return Empty when there is no such source or several.
std::string find_source(std::span<const TelemetryFile> files, const std::string& name);

/// Returns the files in the order given. A path is a CSV file or a directory, which stands for its
/// *.csv files sorted by name.
/// @return InvalidConfiguration with every path that cannot be read, every directory without
///         telemetry and every invalid header, one a line.
Expected<std::vector<TelemetryFile>> scan_telemetry(std::span<const std::filesystem::path> paths);

}  // namespace spindrift
