/// @file
/// Checks whether the archive's disk is writable, suits a write-ahead log, and has enough space.

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

struct DiskFacts {
  std::string folder;
  bool writable;              ///< Whether folder and archive are writable.
  std::uint64_t free_bytes;   ///< Free for the current user.
  std::uint64_t file_system;  ///< Magic number from statfs.
};

/// @return Unavailable when the folder of `db` cannot be examined.
Expected<DiskFacts> disk_facts(const std::filesystem::path& db);

/// @param spacecraft Number of spacecraft that fill the archive.
std::vector<Check> check_disk(const Expected<DiskFacts>& facts, std::size_t spacecraft);

}  // namespace spindrift::doctor
