/// @file
/// `spindrift batch`: computes the maximum-likelihood solution of a stored run on demand. It only
/// reads the archive, so it works while a service writes it.

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
  std::optional<std::string> run;                ///< Empty means the newest run of the spacecraft.
  std::optional<std::int64_t> last_revolutions;  ///< Empty means all revolutions.
  bool json = false;
};

/// Prints the solution on standard output.
/// @return InvalidConfiguration for bad input; Unobservable where the edges do not suffice.
Expected<void> batch(const BatchOptions& options);

}  // namespace spindrift
