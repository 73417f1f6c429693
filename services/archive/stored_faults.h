/// @file
/// Reads which computations of a run failed, and which of its samples contradict each other.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/run_fault.h"

namespace spindrift {

/// Returns the faults of a run in order of time; errors as find_stored_passes.
Expected<std::vector<RunFault>> find_faults(const std::filesystem::path& archive,
                                            const std::string& run_id);

/// Counts a run's instants with several values, by kind; errors as find_stored_passes.
Expected<std::map<std::string, std::int64_t>> count_contradictions(
    const std::filesystem::path& archive, const std::string& run_id);

}  // namespace spindrift
