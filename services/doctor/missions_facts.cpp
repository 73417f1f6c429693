#include <toml++/toml.h>

#include "pipelines/time/time_span.h"
#include "services/doctor/missions.h"
#include "services/mission/igrf.h"
#include "services/simulation/ground_model.h"

namespace spindrift::doctor {
namespace {

/// Returns tables that only the other kind of spacecraft uses.
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

/// Number of steps in the pass; gaps of an ephemeris shorter than a step are not found.
constexpr int kLooks = 1000;

void look_for_orbit(const Orbit& orbit, const ComingPass& pass, MissionFacts& facts) {
  facts.never_an_orbit = true;
  for (int i = 0; i <= kLooks; ++i) {
    const TaiTime t = shifted(pass.from, elapsed_s(pass.from, pass.to) * i / kLooks);
    if (orbit.at(t)) {
      facts.never_an_orbit = false;
    } else if (!facts.no_orbit_at) {
      facts.no_orbit_at = t;
    }
  }
}

void look_at_model(const Mission& mission, MissionFacts& facts) {
  if (!mission.ground_model) {
    return;
  }
  if (const auto model = load_ground_model(*mission.ground_model, mission)) {
    const ModelSpan span = span_of(**model);
    facts.ground_model = {.from = span.from, .to = span.to};
  } else {
    facts.model_problem = model.error().message;
  }
}

}  // namespace

MissionFacts mission_facts(const Mission& mission, const ComingPass& pass) {
  MissionFacts facts{
      .spacecraft = mission.spacecraft_id,
      .kind = mission.kind(),
      .ephemeris = {},
      .no_orbit_at = {},
      .field_to = field_end(mission),
      .infrared = mission.spin() == nullptr || mission.spin()->north || mission.spin()->south,
      .idle = idle_tables(mission),
      .orbit_doubts = mission.orbit_doubts};
  look_at_model(mission, facts);
  if (!mission.orbit) {
    facts.orbit_given = false;
    return facts;
  }
  if (const OrbitEphemeris* const ephemeris = mission.orbit->ephemeris()) {
    facts.ephemeris = {.from = ephemeris->usable_from(), .to = ephemeris->usable_to()};
  }
  look_for_orbit(*mission.orbit, pass, facts);
  return facts;
}

}  // namespace spindrift::doctor
