/// @file
/// Checks that the mission files fit the pass: one per spacecraft, orbits that cover it, and a
/// valid geomagnetic model for a magnetometer.

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/doctor/check.h"
#include "services/mission/mission.h"

namespace spindrift::doctor {

/// Time span of an ephemeris, possibly with gaps, or of the ground model.
struct Coverage {
  TaiTime from;
  TaiTime to;
};

/// A key of alignment at its default, and what it adds to sigma.
struct DefaultAlignment {
  std::string key;  ///< Dotted.
  double value;
  std::optional<double> cost_deg = {};  ///< Empty where it is not known.
  std::string_view where = {};          ///< Circumstances of the cost.
};

/// The coming pass; when none is given, both times are now.
struct ComingPass {
  TaiTime from;
  TaiTime to;
};

struct MissionFacts {
  std::string spacecraft;
  SpacecraftKind kind = SpacecraftKind::Spin;
  std::optional<Coverage> ephemeris;   ///< Empty without an ephemeris.
  bool orbit_given = true;             ///< Whether the mission file has an orbit.
  std::optional<TaiTime> no_orbit_at;  ///< First time of the pass without an orbit.
  bool never_an_orbit = false;         ///< Whether no part of the pass has an orbit.
  /// End of the geomagnetic model; empty without a magnetometer.
  std::optional<TaiTime> field_to = {};
  bool infrared = true;                        ///< Whether it has infrared sensors.
  std::vector<std::string> idle;               ///< Tables of the file that are not used.
  std::vector<std::string> orbit_doubts = {};  ///< See mission.h.
  std::optional<Coverage> ground_model = {};   ///< Empty without a usable ground model.
  std::string model_problem = {};              ///< Empty when the model has no problem.
  std::vector<DefaultAlignment> defaults = {};
  std::optional<ComingPass> planned = {};  ///< Pass of a spinner for which `defaults` have costs.
};

MissionFacts mission_facts(const Mission& mission, const ComingPass& pass);

std::vector<Check> check_missions(std::span<const MissionFacts> missions, const ComingPass& pass);

}  // namespace spindrift::doctor
