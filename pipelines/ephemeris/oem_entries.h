/// @file
/// The `KEY = value` lines of an OEM (CCSDS 502.0-B), their errors, and the metadata of a segment
/// that they give. For its parser only.

#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct OemEntry {
  int line;
  std::string value;
};
/// Entries by key.
using OemEntries = std::map<std::string_view, OemEntry>;

using OemReadTime = Expected<TaiTime> (*)(std::string_view);

/// Returns InvalidConfiguration with the line number.
Unexpected oem_refused(int line, std::string_view what);
/// Returns InvalidConfiguration with line number, key and value.
Unexpected oem_refused(std::string_view key, const OemEntry& entry, std::string_view what);

/// Returns the finite number that `word` as a whole is; empty: it is none.
std::optional<double> oem_number(std::string_view word);

/// Returns the value of `key`, which must be present, in capitals, if it is one of `allowed`.
Expected<std::string> oem_choice(const OemEntries& entries, std::string_view key,
                                 std::span<const std::string_view> allowed);

/// Returns the time of `key`, which must be present.
Expected<TaiTime> oem_time(const OemEntries& entries, std::string_view key, OemReadTime read_time);

/// The metadata of a segment.
struct OemMetadata {
  std::string object_name;
  std::string object_id;
  OemReadTime read_time = nullptr;
  TaiTime start;
  TaiTime stop;
  TaiTime usable_start;
  TaiTime usable_stop;
  std::optional<Interpolation> interpolation;
  int degree = 0;  ///< Degree of `interpolation`.
};

/// @param entries Must hold all keys that the standard requires.
/// @return InvalidConfiguration with line, key and what is allowed.
Expected<OemMetadata> oem_metadata_from(const OemEntries& entries);

}  // namespace spindrift
