/// @file
/// Which kind of telemetry a file holds, and in which columns; its header line tells.

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
// Written as a whole, never default-constructed.
struct TelemetryLayout {
  TelemetryKind kind;
  std::size_t columns;                           ///< With `spacecraft`, where there is one.
  std::optional<std::size_t> spacecraft_column;  ///< From 0.
};

struct OpenTelemetry {
  FileLines lines;  ///< Those behind the header.
  TelemetryLayout layout;
};

/// Of a kind: "t_tai_ns,channel".
template <class Value>
std::string header_of() {
  std::string header = "t_tai_ns";
  std::apply([&](const auto&... column) { (((header += ',') += column.name), ...); },
             Telemetry<Value>::kColumns);
  return header;
}

/// Opens a file and reads its header line, the first that is not empty.
/// @return InvalidConfiguration with path and line for what is not a readable file, no header or
///         one that is not known, saying which there are; Unavailable when reading fails.
Expected<OpenTelemetry> open_telemetry(const std::filesystem::path& path);

}  // namespace spindrift
