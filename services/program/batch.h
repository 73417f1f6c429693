/// @file
/// `spindrift batch`: the maximum-likelihood solution of a stored run, on demand. Only reads: also
/// while a service writes the archive.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"

namespace spindrift {

struct BatchOptions {
  std::filesystem::path mission;
  std::filesystem::path db;
  std::optional<std::string> run;                ///< Empty: the newest of the spacecraft.
  std::optional<std::int64_t> last_revolutions;  ///< Empty: all.
  bool json = false;
};

/// Prints the solution on standard output.
/// @return InvalidConfiguration for bad input; Unobservable where the edges do not suffice.
Expected<void> batch(const BatchOptions& options);

}  // namespace spindrift
