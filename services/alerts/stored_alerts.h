/// @file
/// The alerts that an archive holds.

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
  RunMode mode;  ///< Of its run.
  Alert alert;   ///< Without its last change.
};

/// Of each run in the order in which they were raised, run by run.
std::vector<StoredAlert> alerts_in(SQLite::Database& archive);

/// Likewise. @return As find_stored_passes.
Expected<std::vector<StoredAlert>> find_alerts(const std::filesystem::path& archive);

}  // namespace spindrift
