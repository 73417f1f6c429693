/// @file
/// Reads from a file's header line its kind of telemetry and its columns.

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>

#include "pipelines/core/expected.h"
#include "services/base/file_lines.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/csv.h"

namespace spindrift {

/// The columns of one file.
// No defaults, since it is always written as a whole.
struct TelemetryLayout {
  TelemetryKind kind;
  std::size_t columns;                           ///< Including `spacecraft`, if present.
  std::optional<std::size_t> spacecraft_column;  ///< Counted from 0.
};

struct OpenTelemetry {
  FileLines lines;  ///< The lines after the header.
  TelemetryLayout layout;
};

/// Returns the header of a kind, as "t_tai_ns,channel".
template <class Value>
std::string header_of() {
  std::string header = "t_tai_ns";
  std::apply([&](const auto&... column) { (((header += ',') += column.name), ...); },
             Telemetry<Value>::kColumns);
  return header;
}

/// Opens a file and reads its header, the first line that is not empty.
/// @return InvalidConfiguration with path and line for an unreadable file and a missing or unknown
///         header, listing the known ones; Unavailable when reading fails.
Expected<OpenTelemetry> open_telemetry(const std::filesystem::path& path);

}  // namespace spindrift
