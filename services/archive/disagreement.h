/// @file
/// Which estimators of a run give axes that their sigmas do not explain: those that the view
/// spin_comparison flags, whose rule is the only one.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/words/disagreement_words.h"

namespace spindrift {

/// Of the last estimates that are stored.
/// @return As find_stored_passes.
Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id);

}  // namespace spindrift
