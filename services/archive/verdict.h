/// @file
/// What the archive's views say of a run: their rules are the only ones.

#pragma once

#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/pass_verdict.h"

namespace spindrift {

/// Two estimators whose axes differ by more than their sigmas explain.
struct Disagreement {
  std::string one;  ///< Estimators, as in spin_estimate.
  std::string other;
  double apart_deg;
  double apart_sigmas;  ///< The larger of the two, for they share their edges.
};

/// In the order of `run_ids`, all of one moment of the archive. Throws SQLite::Exception.
std::vector<PassVerdict> verdicts_in(SQLite::Database& archive,
                                     const std::vector<std::string>& run_ids);
/// Of what is stored. @return As find_stored_passes.
Expected<PassVerdict> find_verdict(const std::filesystem::path& archive, const std::string& run_id);

/// Which estimators of a run give axes that their sigmas do not explain: those that the view
/// spin_comparison flags. Of the last estimates that are stored.
/// @return As find_stored_passes.
Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id);

}  // namespace spindrift
