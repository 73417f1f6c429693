/// @file
/// What the archive's views say of a run: their rules are the only ones.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/words/disagreement_words.h"

namespace spindrift {

/// A row of the view pass_verdict.
struct PassVerdict {
  bool finished = false;  ///< Otherwise the run goes on, or was interrupted or killed.
  /// @name Empty: the run has no answer
  /// @{
  std::string estimator = {};
  std::string quality = {};  ///< There is one of a run that failed, too.
  std::optional<double> sigma_deg = {};
  /// @}
  std::string why = {};
};

/// Of what is stored. @return As find_stored_passes.
Expected<PassVerdict> find_verdict(const std::filesystem::path& archive, const std::string& run_id);

/// Which estimators of a run give axes that their sigmas do not explain: those that the view
/// spin_comparison flags. Of the last estimates that are stored.
/// @return As find_stored_passes.
Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id);

}  // namespace spindrift
