/// @file
/// A planned pass with its request, to be reported.

#pragma once

#include <string>

#include "pipelines/spin/planning/pass_plan.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

struct PlannedPass {
  std::string spacecraft_id;
  SpinConfig config;
  PassRequest request;
  bool rate_assumed;  ///< True where the rate was not given but assumed.
  PassPlan plan;
};

}  // namespace spindrift
