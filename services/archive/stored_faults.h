/// @file
/// What failed to compute of a run, and what contradicts itself in its samples.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/run_fault.h"

namespace spindrift {

/// In order of time.
/// @return As find_stored_passes.
Expected<std::vector<RunFault>> find_faults(const std::filesystem::path& archive,
                                            const std::string& run_id);

/// How many instants of a run have more than one value, by kind of sample. @return Likewise.
Expected<std::map<std::string, std::int64_t>> count_contradictions(
    const std::filesystem::path& archive, const std::string& run_id);

}  // namespace spindrift
