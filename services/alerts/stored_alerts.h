/// @file
/// Reads the alerts of an archive.

#pragma once

#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/supervision/alert.h"
#include "services/archive/records.h"

namespace spindrift {

struct StoredAlert {
  std::string run_id;
  std::string spacecraft;
  RunMode mode;  ///< Mode of the alert's run.
  Alert alert;   ///< Without its latest transition.
};

struct StoredTransition {
  std::string spacecraft;
  TaiTime t;
};

/// Returns the alerts run by run, each run's in the order in which they were raised.
std::vector<StoredAlert> alerts_in(SQLite::Database& archive);

/// Opens the archive and reads its alerts. @return The errors of find_stored_passes.
Expected<std::vector<StoredAlert>> find_alerts(const std::filesystem::path& archive);

/// Opens the archive and reads the transitions of the alerts of runs of a mode, run by run.
/// @return The errors of find_stored_passes.
Expected<std::vector<StoredTransition>> find_transitions(const std::filesystem::path& archive,
                                                         RunMode mode);

}  // namespace spindrift
