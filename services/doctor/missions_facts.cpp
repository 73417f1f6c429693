#include <toml++/toml.h>

#include "services/doctor/missions.h"

namespace spindrift::doctor {
namespace {

/// Tables that only the other kind of spacecraft has a use for.
std::vector<std::string> idle_tables(const Mission& mission) {
  const toml::table document = toml::parse(mission.toml_text);
  std::vector<std::string> idle;
  for (const char* name : {"spin", "three_axis", "reconstruction"}) {
    const bool of_spinner = std::string_view{name} == "spin";
    if (document.contains(name) && of_spinner != (mission.spin() != nullptr)) {
      idle.emplace_back(name);
    }
  }
  return idle;
}

}  // namespace

MissionFacts mission_facts(const Mission& mission, TaiTime now) {
  MissionFacts facts{
      .spacecraft = mission.spacecraft_id,
      .kind = mission.kind(),
      .ephemeris = {},
      .no_orbit_now = {},
      .infrared = mission.spin() == nullptr || mission.spin()->north || mission.spin()->south,
      .idle = idle_tables(mission),
      .orbit_doubts = mission.orbit_doubts};
  if (!mission.orbit) {
    return facts;
  }
  if (const OrbitEphemeris* const ephemeris = mission.orbit->ephemeris()) {
    facts.ephemeris = {.from = ephemeris->usable_from(), .to = ephemeris->usable_to()};
  }
  if (const auto state = mission.orbit->at(now); !state) {
    facts.no_orbit_now = state.error().message;
  }
  return facts;
}

}  // namespace spindrift::doctor
