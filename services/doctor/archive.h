/// @file
/// Checks an archive: its integrity, its version, and who writes it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

/// Findings in the tables.
struct ArchiveContent {
  std::vector<std::string> damages = {};  ///< The first ten, as SQLite reports them.
  bool looked_at_everything = true;       ///< False: only the tables' structure.
  std::int64_t orphans = 0;               ///< Rows that refer to a missing row.
  std::int64_t unfinished_runs = 0;
  int tai_minus_utc_s = 0;  ///< Last offset of its leap seconds; 0 if none.
};

struct ArchiveFacts {
  std::string path;
  bool exists = false;
  std::uint64_t bytes = 0;
  std::uint64_t wal_bytes = 0;
  std::optional<std::string> writer;  ///< Holder of the write lock, as it names itself.
  Expected<ArchiveContent> content;   ///< Error when it cannot be opened or read.
};

/// Only reads, and takes no lock that could block a writer.
ArchiveFacts archive_facts(const std::filesystem::path& path);

/// @param program_tai_minus_utc_s Last offset in the program's leap second table.
std::vector<Check> check_archive(const ArchiveFacts& facts, int program_tai_minus_utc_s);

}  // namespace spindrift::doctor
