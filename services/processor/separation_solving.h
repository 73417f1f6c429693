/// @file
/// Reconstructs a separation and gives the result as products to be stored.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/separation.h"
#include "services/products/products.h"

namespace spindrift {

struct SolvedSeparation {
  std::vector<ReconstructionProduct> methods;  ///< The solution of `batch` first.
  std::vector<std::string> failures;           ///< Why methods gave no solution, each reason once.

  /// Returns the solutions and what they say of the mission file.
  std::vector<Product> products() const;
};

/// Solves by `method`, or by both methods when it is empty.
SolvedSeparation solve_separation(const ReconstructionRequest& request,
                                  const std::optional<LauncherAttitude>& launcher,
                                  std::optional<ReconstructionMethod> method);

}  // namespace spindrift
