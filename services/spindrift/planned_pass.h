/// @file
/// A planned pass with what was asked for, to be shown.

#pragma once

#include <string>

#include "pipelines/spin/config.h"
#include "pipelines/spin/pass_plan.h"

namespace spindrift {

struct PlannedPass {
  std::string spacecraft_id;
  SpinConfig config;
  PassRequest request;
  bool rate_assumed;  ///< Nobody has said it.
  PassPlan plan;
};

}  // namespace spindrift
