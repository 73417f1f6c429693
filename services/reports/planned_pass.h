/// @file
/// A planned pass with what was asked for, to be shown.

#pragma once

#include <string>

#include "pipelines/spin/planning/pass_plan.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

struct PlannedPass {
  std::string spacecraft_id;
  SpinConfig config;
  PassRequest request;
  bool rate_assumed;  ///< Nobody has said it.
  PassPlan plan;
};

}  // namespace spindrift
