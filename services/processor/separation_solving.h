/// @file
/// The reconstruction of a separation as a product to be stored.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/separation.h"
#include "services/products/products.h"

namespace spindrift {

struct SolvedSeparation {
  std::vector<ReconstructionProduct> methods;  ///< `batch` first.
  std::vector<std::string> failures;           ///< Why others are missing, each once.
};

/// By one method, or by both.
SolvedSeparation solve_separation(const ReconstructionRequest& request,
                                  const std::optional<LauncherAttitude>& launcher,
                                  std::optional<ReconstructionMethod> method);

}  // namespace spindrift
