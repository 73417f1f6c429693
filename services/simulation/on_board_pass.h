/// @file
/// A simulated satellite computes its attitude itself, from Sun and field, by the table of the
/// field that it carries.

#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "services/simulation/scenario.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

/// How far an attitude computed on board is from the truth.
struct OnBoardError {
  double t_s;  ///< Time since the start.
  double with_table_rad;
  double with_field_rad;  ///< Error if the field itself stood in place of the table.
  double by_table_rad;    ///< Angle by which the table moves the attitude.
};

struct OnBoardPass {
  std::size_t table_bytes;
  std::vector<OnBoardError> errors;  ///< Errors in order of time.
};

/// Computes the attitude from each pair of a sun vector and a field that the ground receives, too.
/// @param scenario Scenario whose spacecraft carries a table.
/// @return NoCoverage where the field is not known at the epoch of the orbit.
Expected<OnBoardPass> on_board_pass(const Scenario& scenario, const PlacedValues& telemetry,
                                    const BodyMotion& motion);

nlohmann::ordered_json to_json(const OnBoardPass& pass);

/// @param json As `to_json` gives it.
std::string on_board_text(const CarriedTable& table, const nlohmann::ordered_json& json);

}  // namespace spindrift
