#include <toml++/toml.h>

#include "pipelines/time/time_span.h"
#include "services/doctor/missions.h"
#include "services/geomagnetism/igrf.h"

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

std::optional<TaiTime> field_end(const Mission& mission) {
  const auto* const three_axis = std::get_if<ThreeAxisConfig>(&mission.config);
  return three_axis != nullptr && three_axis->magnetometer ? std::optional{igrf_end()}
                                                           : std::nullopt;
}

/// Holes of an ephemeris that are shorter than this many steps of the pass are not looked for.
constexpr int kLooks = 1000;

std::string no_orbit_in(const Orbit& orbit, const ComingPass& pass) {
  for (int i = 0; i <= kLooks; ++i) {
    const TaiTime t = shifted(pass.from, elapsed_s(pass.from, pass.to) * i / kLooks);
    if (const auto state = orbit.at(t); !state) {
      return state.error().message;
    }
  }
  return {};
}

}  // namespace

MissionFacts mission_facts(const Mission& mission, const ComingPass& pass) {
  MissionFacts facts{
      .spacecraft = mission.spacecraft_id,
      .kind = mission.kind(),
      .ephemeris = {},
      .no_orbit = {},
      .field_to = field_end(mission),
      .infrared = mission.spin() == nullptr || mission.spin()->north || mission.spin()->south,
      .idle = idle_tables(mission),
      .orbit_doubts = mission.orbit_doubts};
  if (!mission.orbit) {
    facts.no_orbit = "the mission file gives none, and orbit states may not come";
    return facts;
  }
  if (const OrbitEphemeris* const ephemeris = mission.orbit->ephemeris()) {
    facts.ephemeris = {.from = ephemeris->usable_from(), .to = ephemeris->usable_to()};
  }
  facts.no_orbit = no_orbit_in(*mission.orbit, pass);
  return facts;
}

}  // namespace spindrift::doctor
