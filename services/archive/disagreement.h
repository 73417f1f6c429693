/// @file
/// Which estimators of a run give axes that their sigmas do not explain: those that the view
/// spin_comparison flags, whose rule is the only one.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct Disagreement {
  std::string one;  ///< Estimators, as in spin_estimate.
  std::string other;
  double apart_deg;
  double apart_sigmas;  ///< The larger of the two, for they share their edges.
};

/// "mean and batch disagree: their axes are 0.31 deg apart, 4.2 times the larger sigma".
std::string in_words(const Disagreement& disagreement);

/// Of the last estimates that are stored.
/// @return As find_stored_passes.
Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id);

}  // namespace spindrift
