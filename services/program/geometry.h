/// @file
/// `spindrift geometry`: what a coming pass will show, and how well the axis can be known from it.

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"

namespace spindrift {

struct GeometryOptions {
  std::filesystem::path mission;
  std::string from;      ///< UTC, ISO 8601 ending in Z.
  std::string to;        ///< Likewise.
  std::string attitude;  ///< "RA,DEC" of the spin axis in deg, ICRF.
  std::optional<double> rate_rpm;
  std::optional<double> step_s;
  std::filesystem::path plot;  ///< An SVG to write; empty: none.
  bool json = false;
};

/// Prints the plan on standard output.
/// @return InvalidConfiguration for a bad mission file or bad arguments, every one of them named,
///         and for an orbit that does not reach; Unavailable where the plot cannot be written.
Expected<void> geometry(const GeometryOptions& options);

}  // namespace spindrift
