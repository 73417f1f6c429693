/// @file
/// Report of a reconstructed separation as text, JSON and SVG.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "services/products/reconstruction.h"

namespace spindrift {

struct SeparationReport {
  std::string spacecraft_id;
  std::string run_id;
  /// Results by method, at least one; the first is reported first.
  std::vector<ReconstructionProduct> methods;
};

/// The launcher's attitude is consistent above this probability of as large a difference.
inline constexpr double kLeastChance = 0.01;

/// Returns lines of events, attitudes in ICRF and in the orbit frame, bias, launcher and quality.
std::string to_text(const SeparationReport& report);

/// Returns the object described in services/program/json.md.
nlohmann::json to_json(const SeparationReport& report);

/// Returns a self-contained SVG: attitude with its uncertainty from separation to the last star
/// fix, over UTC, with the events marked. Empty where the history is of one instant.
std::string plot_of(const SeparationReport& report);

}  // namespace spindrift
