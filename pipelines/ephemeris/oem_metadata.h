/// @file
/// The metadata of a segment of an OEM (CCSDS 502.0-B). For its parser only.

#pragma once

#include <optional>
#include <string>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/oem_entries.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

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
