/// @file
/// The place of the archive: is it writable, fit for a write-ahead log, and how long does it last.

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
  bool writable;              ///< The folder, and the archive where there is one.
  std::uint64_t free_bytes;   ///< For whoever runs this.
  std::uint64_t file_system;  ///< Its magic number, of statfs.
};

/// @return Unavailable when the folder of `db` cannot be looked at.
Expected<DiskFacts> disk_facts(const std::filesystem::path& db);

/// @param spacecraft How many fill the archive.
std::vector<Check> check_disk(const Expected<DiskFacts>& facts, std::size_t spacecraft);

}  // namespace spindrift::doctor
