/// @file
/// The `KEY = value` lines of an Orbit Ephemeris Message (CCSDS 502.0-B), and how a
/// value is refused. For its parser only.

#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct OemEntry {
  int line;
  std::string value;
};
/// By key.
using OemEntries = std::map<std::string_view, OemEntry>;

using OemReadTime = Expected<TaiTime> (*)(std::string_view);

/// InvalidConfiguration that names the line.
Unexpected oem_refused(int line, std::string_view what);
/// And key and value.
Unexpected oem_refused(std::string_view key, const OemEntry& entry, std::string_view what);

/// A finite number, if `word` is one as a whole.
std::optional<double> oem_number(std::string_view word);

/// The value of `key`, which must stand there, in capitals, if it is one of `allowed`.
Expected<std::string> oem_choice(const OemEntries& entries, std::string_view key,
                                 std::span<const std::string_view> allowed);

/// The time of `key`, which must stand there.
Expected<TaiTime> oem_time(const OemEntries& entries, std::string_view key, OemReadTime read_time);

}  // namespace spindrift
