/// @file
/// `spindrift simulate`: a pass made from a scenario, into files or onto the bus.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "pipelines/core/expected.h"

namespace spindrift {

struct SimulateOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< Folder for the files, written before anything is published.
  bool publish = false;
  double speed = 1.0;  ///< Times real time; 0: as fast as it is taken.
  bool now = false;    ///< The pass is of the present.
  std::uint32_t domain = 0;
  std::string partition = "replay";
  std::int64_t runs = 0;  ///< So many, of seeds and dispersions; 0: one pass, as it stands.
  int jobs = 1;           ///< Threads for them.
  bool plots = false;     ///< With the files of one pass, of a three-axis spacecraft.
  bool json = false;
};

/// Prints what it made on standard output.
/// @return InvalidConfiguration for a bad scenario; Unavailable when the files cannot be written,
///         nobody subscribes or the bus fails.
Expected<void> simulate(const SimulateOptions& options);

}  // namespace spindrift
