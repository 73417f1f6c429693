/// @file
/// Report of a reconstructed separation.

#pragma once

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

}  // namespace spindrift
