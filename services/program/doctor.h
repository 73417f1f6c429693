/// @file
/// `spindrift doctor`: reports what is wrong before a pass, and what to do about it.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct DoctorOptions {
  std::vector<std::filesystem::path> missions;
  std::filesystem::path db;  ///< Empty means that neither archive nor disk is checked.
  std::uint32_t domain = 0;
  std::string partition = "live";
  std::string from;  ///< Start of the coming pass, UTC; empty means now.
  std::string to;
  bool verbose = false;  ///< Also print the checks that passed.
  bool json = false;
};

/// Prints its findings on standard output. Call it before any thread is started.
/// @return whether a pass can be taken; InvalidConfiguration when a mission file or a time is bad.
Expected<bool> run_doctor(const DoctorOptions& options);

}  // namespace spindrift
