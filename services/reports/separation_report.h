/// @file
/// What is told of a reconstructed separation.

#pragma once

#include <string>
#include <vector>

#include "services/products/reconstruction.h"

namespace spindrift {

struct SeparationReport {
  std::string spacecraft_id;
  std::string run_id;
  std::vector<ReconstructionProduct> methods;  ///< One at least, the one to report first.
};

/// The launcher's attitude is inside where the chance is at least so much that errors alone keep
/// the two as far apart.
inline constexpr double kLeastChance = 0.01;

}  // namespace spindrift
