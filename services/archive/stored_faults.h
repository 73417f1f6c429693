/// @file
/// What failed to compute of a run.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/run_fault.h"

namespace spindrift {

/// In order of time.
/// @return As find_stored_passes.
Expected<std::vector<RunFault>> find_faults(const std::filesystem::path& archive,
                                            const std::string& run_id);

}  // namespace spindrift
