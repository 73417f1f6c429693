/// @file
/// The archive as it lies on the disk: whole, of this program's version, and who writes it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

/// What its tables say.
struct ArchiveContent {
  std::vector<std::string> damages = {};  ///< The first ten, in SQLite's words.
  bool looked_at_everything = true;       ///< Not only at the structure of each table.
  std::int64_t orphans = 0;               ///< Rows that name a row which is not there.
  std::int64_t unfinished_runs = 0;
  int tai_minus_utc_s = 0;  ///< The last offset of its leap seconds; 0: it has none.
};

struct ArchiveFacts {
  std::string path;
  bool exists = false;
  std::uint64_t bytes = 0;
  std::uint64_t wal_bytes = 0;
  std::optional<std::string> writer;  ///< Who holds the right to write it, in its own words.
  Expected<ArchiveContent> content;   ///< An error when it cannot be opened or read.
};

/// Reads only, and takes no lock that a writer would feel.
ArchiveFacts archive_facts(const std::filesystem::path& path);

/// @param program_tai_minus_utc_s The last offset of the leap seconds that this program knows.
std::vector<Check> check_archive(const ArchiveFacts& facts, int program_tai_minus_utc_s);

}  // namespace spindrift::doctor
