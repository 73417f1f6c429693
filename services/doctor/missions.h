/// @file
/// Whether the mission files fit the pass: one for each spacecraft, orbits that reach, and the
/// Earth's field for a magnetometer.

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/doctor/check.h"
#include "services/mission/mission.h"

namespace spindrift::doctor {

/// Of an ephemeris, where there may be holes between; of the ground model.
struct Coverage {
  TaiTime from;
  TaiTime to;
};

struct MissionFacts {
  std::string spacecraft;
  SpacecraftKind kind = SpacecraftKind::Spin;
  std::optional<Coverage> ephemeris;  ///< Absent where the orbit is given otherwise, or not at all.
  bool orbit_given = true;            ///< By the mission file.
  std::optional<TaiTime> no_orbit_at;  ///< The first time of the pass without one; empty: none is.
  bool never_an_orbit = false;         ///< Of the pass.
  /// Of the model of the Earth's field; empty: no magnetometer.
  std::optional<TaiTime> field_to = {};
  bool infrared = true;                        ///< It has an infrared sensor.
  std::vector<std::string> idle;               ///< Tables of the file that nothing reads.
  std::vector<std::string> orbit_doubts = {};  ///< See mission.h.
  std::optional<Coverage> ground_model = {};   ///< Of it; empty: there is none, or none that works.
  std::string model_problem = {};              ///< Why; empty: nothing is wrong with it.
};

/// That is to come; without one, the moment of now.
struct ComingPass {
  TaiTime from;
  TaiTime to;
};

MissionFacts mission_facts(const Mission& mission, const ComingPass& pass);

std::vector<Check> check_missions(std::span<const MissionFacts> missions, const ComingPass& pass);

}  // namespace spindrift::doctor
