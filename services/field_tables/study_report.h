/// @file
/// A study of field tables for people and programs: text, JSON, and plots like figures 4, 6, 7, 9
/// and 10 of Liu 2019.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/geomagnetism/tables/table_study.h"

namespace spindrift {

std::string to_text(const FieldStudy& study);
nlohmann::json to_json(const FieldStudy& study);

struct StudyPlot {
  std::string name;  ///< Name of its file, "weight.svg".
  std::string svg;
};
std::vector<StudyPlot> plots_of(const FieldStudy& study);

}  // namespace spindrift
