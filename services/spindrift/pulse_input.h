/// @file
/// Recorded pulses as `process` and `replay` take them.

#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "pipelines/core/expected.h"
#include "services/telemetry_files/pulse_file.h"

namespace spindrift {

/// All pulses among `paths` (files, or directories of them) in the order of their time. Files of
/// another kind are left out with a warning.
/// @param spacecraft Of the rows, where a file does not say.
/// @return InvalidConfiguration for unreadable files, and where there is no row of pulses at all.
Expected<PulseTelemetry> load_pulses(std::span<const std::filesystem::path> paths,
                                     const std::string& spacecraft);

/// How many rows were bad, and the first few of them.
std::string bad_rows(const std::vector<RejectedInput>& rejected);

}  // namespace spindrift
