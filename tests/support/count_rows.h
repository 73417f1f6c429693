/// @file
/// Counts rows of an archive.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/support/archive_rows.h"

namespace spindrift {

/// @param from Table, with what joins and restricts its rows.
inline std::int64_t count_rows(const std::filesystem::path& db, const std::string& from) {
  return number_of(db, "SELECT count(*) FROM " + from);
}

}  // namespace spindrift
