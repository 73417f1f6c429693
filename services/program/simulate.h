/// @file
/// `spindrift simulate`: simulates a pass from a scenario, into files or onto the bus.

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
  double speed = 1.0;  ///< Multiple of real time; 0 means as fast as subscribers take it.
  bool now = false;    ///< Shift the pass to the present.
  std::uint32_t domain = 0;
  std::string partition = "replay";
  std::int64_t runs = 0;  ///< Number of Monte Carlo runs; 0 means one pass without dispersions.
  int jobs = 1;           ///< Number of threads for Monte Carlo runs.
  bool plots = false;     ///< Also write plots; only for one pass of a three-axis spacecraft.
  bool json = false;
};

/// Prints a summary of the pass on standard output.
/// @return InvalidConfiguration for a bad scenario; Unavailable when the files cannot be written,
///         nobody subscribes or the bus fails.
Expected<void> simulate(const SimulateOptions& options);

}  // namespace spindrift
