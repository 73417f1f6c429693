/// @file
/// When a run has ended, says whether its estimators disagree.

#pragma once

#include <filesystem>
#include <span>

#include "services/archive/records.h"

namespace spindrift {

/// A warning for each two that do, of the runs that end in what was just stored.
void warn_of_disagreements(const std::filesystem::path& db, std::span<const ArchiveBatch> stored);

}  // namespace spindrift
