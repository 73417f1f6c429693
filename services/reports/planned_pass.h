/// @file
/// A planned pass with its request, reported as text, JSON and SVG.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipelines/spin/planning/pass_conditions.h"
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

/// Returns a sentence such as "north beam sees the Earth".
std::string sentence_of(const PassCondition& condition);

/// Returns one line with the times, the axis and the rate.
std::string title_of(const PlannedPass& pass);

/// Returns a table of the steps, then the conditions with their times.
std::string to_text(const PlannedPass& pass);

/// Returns the pass with angles in deg; null where there is none.
nlohmann::json to_json(const PlannedPass& pass);

/// Returns an SVG: angles, chords, |Delta|, expected sigma, and what each sensor sees, over UTC.
std::string plot_of(const PlannedPass& pass);

}  // namespace spindrift
