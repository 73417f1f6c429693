/// @file
/// Result of comparing the flight data of a pass with the ground model, as text, JSON and SVG.

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/ground_model/comparison/model_comparison.h"

namespace spindrift {

struct ComparisonReport {
  std::string spacecraft_id;
  std::filesystem::path model;  ///< Scenario file of the model.
  ModelSpan span;               ///< Time span of the model.
  double band_sigmas;
  std::vector<ChannelComparison> channels;
};

/// Returns a table with a row per channel, and a line per departure.
std::string to_text(const ComparisonReport& report);

/// Returns the object described in services/program/json.md.
nlohmann::json to_json(const ComparisonReport& report);

/// Returns an SVG: for each sensor the values of flight over those of the model, and the residuals
/// in sigma with the band. Starts of departures are marked.
/// @param samples In the order in which they were compared; at least one has a value.
std::string plot_of(const ComparisonReport& report, const std::vector<ComparedSample>& samples);

}  // namespace spindrift
