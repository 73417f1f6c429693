/// @file
/// `spindrift geometry`: predicts a coming pass and how well it determines the spin axis.

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"

namespace spindrift {

struct GeometryOptions {
  std::filesystem::path mission;
  std::string from;      ///< UTC, ISO 8601 ending in Z.
  std::string to;        ///< UTC, ISO 8601 ending in Z.
  std::string attitude;  ///< "RA,DEC" of the spin axis in deg, ICRF.
  std::optional<double> rate_rpm;
  std::optional<double> step_s;
  std::filesystem::path plot;  ///< Path of an SVG to write; empty means none.
  bool json = false;
};

/// Prints the plan on standard output.
/// @return InvalidConfiguration for a bad mission file, an orbit that does not cover the pass, or
///         bad arguments, every one of them named; Unavailable where the plot cannot be written.
Expected<void> geometry(const GeometryOptions& options);

}  // namespace spindrift
