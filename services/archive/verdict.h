/// @file
/// Reads the judgement on a run from the archive's views, and what
/// failed or contradicted itself in it.

#pragma once

#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/pass_verdict.h"
#include "services/products/run_fault.h"

namespace spindrift {

/// Two estimators whose axes differ by more than their sigmas explain.
struct Disagreement {
  std::string one;  ///< Name of an estimator as in spin_estimate.
  std::string other;
  double apart_deg;
  double apart_sigmas;  ///< Angle in sigmas of the difference.
};

/// Returns the verdicts in the order of `run_ids`, all from the same state of the archive.
/// @throws SQLite::Exception
std::vector<PassVerdict> verdicts_in(SQLite::Database& archive,
                                     const std::vector<std::string>& run_ids);
/// Returns the verdict on what is stored of a run; errors as find_stored_passes.
Expected<PassVerdict> find_verdict(const std::filesystem::path& archive, const std::string& run_id);

/// Returns the estimators of a run whose axes differ by more than their sigmas explain, as the view
/// spin_comparison flags them from the last stored estimates; errors as find_stored_passes.
Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id);

/// Returns the faults of a run in order of time; errors as find_stored_passes.
Expected<std::vector<RunFault>> find_faults(const std::filesystem::path& archive,
                                            const std::string& run_id);

/// Counts a run's instants with several values, by kind; errors as find_stored_passes.
Expected<std::map<std::string, std::int64_t>> count_contradictions(
    const std::filesystem::path& archive, const std::string& run_id);

}  // namespace spindrift
