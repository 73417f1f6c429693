#include <toml++/toml.h>

#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/planning/pass_plan.h"
#include "pipelines/time/time_span.h"
#include "services/base/degrees.h"
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

constexpr double kUsualRate_rad_s =
    kTurn_rad;  // 60 rpm; what alignment costs hardly depends on it.
constexpr double kUsualPass_s = 600.0;

/// Returns the pass for which a spinner's alignment is judged.
ComingPass judged_pass(const Mission& mission, const ComingPass& pass) {
  if (pass.from < pass.to) {
    return pass;
  }
  return mission.contact ? ComingPass{.from = mission.contact->from, .to = mission.contact->to}
                         : ComingPass{.from = pass.from, .to = shifted(pass.from, kUsualPass_s)};
}

/// Returns the part of sigma that each error makes in the pass; empty where it cannot be planned.
std::optional<SpinAlignmentVector> planned_costs_rad(const Mission& mission,
                                                     const ComingPass& pass) {
  const SpinConfig& config = *mission.spin();
  if (!mission.target && !config.prior) {
    return std::nullopt;
  }
  const bool has_rate = mission.target && mission.target->rate;
  const auto plan =
      plan_pass(config, *mission.orbit,
                {.from = pass.from,
                 .to = pass.to,
                 .step_s = elapsed_s(pass.from, pass.to),
                 .axis_icrf = mission.target ? mission.target->axis_icrf : config.prior->axis_icrf,
                 .rate_rad_s = has_rate ? mission.target->rate->rad_s : kUsualRate_rad_s});
  return plan && plan->steps.back().sigma_rad
             ? std::optional{plan->steps.back().alignment_sigma_rad}
             : std::nullopt;
}

void look_at_spin_defaults(const Mission& mission, const ComingPass& pass, MissionFacts& facts) {
  const ComingPass planned = judged_pass(mission, pass);
  const auto costs_rad =
      mission.default_sigmas.empty() ? std::nullopt : planned_costs_rad(mission, planned);
  if (costs_rad) {
    facts.planned = planned;
  }
  for (const DefaultSigma& sigma : mission.default_sigmas) {
    facts.defaults.push_back(
        {.key = sigma.key,
         .value = sigma.value,
         .cost_deg =
             costs_rad ? std::optional{(*costs_rad)[sigma.error] * kDegPerRad} : std::nullopt});
  }
}

/// Returns what a default costs an attitude that rests on the sensor alone, all axes together.
DefaultAlignment attitude_default(const DefaultSigma& sigma) {
  constexpr double kWeakField_nT = 30'000.0;
  constexpr double kTurn_deg = 360.0;
  DefaultAlignment one{.key = sigma.key, .value = sigma.value};
  const auto costs = [&](double cost_deg, std::string_view where) {
    one.cost_deg = cost_deg;
    one.where = where;
  };
  if (sigma.error < SunSensorError) {
    costs(std::numbers::sqrt3 * sigma.value, "of an attitude by star fixes");
  } else if (sigma.error < MagnetometerBiasError) {
    costs(std::numbers::sqrt2 * sigma.value, "about the two axes that it shows");
  } else if (sigma.error < GyroScaleError) {
    costs(std::numbers::sqrt2 * sigma.value / kWeakField_nT * kDegPerRad,
          "about the two axes that it shows, in a field of 30000 nT");
  } else if (sigma.error < GyroAxisError) {
    costs(sigma.value * kTurn_deg, "a turn of the body that no other sensor sees");
  } else if (sigma.error < StarTrackerTimeError) {
    costs(std::numbers::sqrt2 * sigma.value * kRadPerDeg * kTurn_deg,
          "a turn of the body that no other sensor sees");
  } else if (sigma.error < InertiaError) {
    costs(sigma.value, "at 1 deg/s");
  } else {
    costs(sigma.value * kTurn_deg, "at most, a turn of the body before the gyro speaks");
  }
  return one;
}

void look_at_defaults(const Mission& mission, const ComingPass& pass, MissionFacts& facts) {
  if (mission.spin() != nullptr) {
    look_at_spin_defaults(mission, pass, facts);
    return;
  }
  for (const DefaultSigma& sigma : mission.default_sigmas) {
    facts.defaults.push_back(attitude_default(sigma));
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
  look_at_defaults(mission, pass, facts);
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
