/// @file
/// What the archive holds of the results of a run that goes on: those that have been announced.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

/// Of the fixes those that are accepted or AMBIGUOUS. Times are the run's, in order.
struct StoredResults {
  /// The last fix, with its best alternate only, and the last estimate of each estimator.
  std::vector<SpinProduct> in_force = {};
  std::vector<std::int64_t> accepted_revolutions = {};
  std::vector<std::int64_t> ambiguous_revolutions = {};
  std::map<SpinEstimator, std::vector<TaiTime>> estimates = {};

  /// Whether it has been given before, were it with other numbers. A fix that is no longer
  /// AMBIGUOUS has not.
  bool hold(const SpinProduct& product) const;
};

/// @return as find_stored_passes.
Expected<StoredResults> find_stored_results(const std::filesystem::path& archive,
                                            const std::string& run_id);

}  // namespace spindrift
