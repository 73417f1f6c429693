#include "services/simulation/spin_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/link/coded_telemetry.h"
#include "services/base/degrees.h"
#include "services/base/progress_bar.h"

namespace spindrift {
namespace {

constexpr int kSlices = 200;

struct ReceivedSpin {
  ReceivedPass pass;
  std::int64_t revolutions;
};

Expected<ReceivedSpin> received(const Scenario& scenario, const SpinScenario& flight,
                                Progress progress) {
  SpinEdges source{flight.truth, scenario.orbit};
  std::vector<TrueEdge> edges;
  std::optional<ProgressBar> bar;
  if (progress == Progress::Shown) {
    bar.emplace("simulating", kSlices);
  }
  for (int slice = 1; slice <= kSlices; ++slice) {
    const auto more = source.until(scenario.duration_s * slice / kSlices);
    if (!more) {
      return Unexpected{more.error()};
    }
    edges.insert(edges.end(), more->begin(), more->end());
    if (bar) {
      bar->advance_to(static_cast<std::uint64_t>(slice));
    }
  }
  return ReceivedSpin{.pass = receive(flight.link, edges, scenario.start, scenario.duration_s,
                                      source.revolutions()),
                      .revolutions = source.revolutions()};
}

std::vector<TelemetryKind> kinds_of(const SimulatedTelemetry& telemetry) {
  std::vector<TelemetryKind> kinds;
  if (telemetry.pulses) {
    kinds.emplace_back(Kind<Pulse>{});
  }
  if (telemetry.coded) {
    kinds.emplace_back(Kind<CodedFrame>{});
  }
  return kinds;
}

PlacedValues telemetry_of(const SimulatedTelemetry& telemetry, const ReceivedPass& pass) {
  PlacedValues values;
  std::int64_t place = 0;
  const auto append = [&]<class Value>(const Value& value) {
    values.of<Value>().push_back({.place = {place++}, .value = value});
  };
  std::vector<CodedFrame> frames;
  if (telemetry.coded) {
    frames = coded_telemetry(pass, telemetry.coded_resolution_s);
  }
  auto frame = frames.begin();
  if (telemetry.pulses) {
    for (const ReceivedPulse& received : pass.pulses) {
      for (; frame != frames.end() && frame->t < received.pulse.t; ++frame) {
        append(*frame);
      }
      append(received.pulse);
    }
  }
  for (; frame != frames.end(); ++frame) {
    append(*frame);
  }
  return values;
}

nlohmann::json bad_edges(const ReceivedPass& pass) {
  nlohmann::json edges = nlohmann::json::array();
  for (const auto& [pulse, damage] : pass.pulses) {
    if (damage) {
      edges.push_back({tai_ns(pulse.t), name_of(pulse.channel), name_of(*damage)});
    }
  }
  return edges;
}

nlohmann::ordered_json nutation(const SpinMotion& motion) {
  const Nutation& nutation = motion.nutation;
  return {{"half_angle_deg", nutation.half_angle_rad * kDegPerRad},
          {"inertia_ratio", nutation.inertia_ratio},
          {"period_s", kTurn_rad / (motion.rate_rad_s * nutation.per_turn())},
          {"phase_deg", nutation.first_azimuth_rad * kDegPerRad},
          {"growth_per_h", nutation.growth_per_s * kHour_s}};
}

nlohmann::ordered_json coning(const Coning& coning) {
  return {{"tilt_deg", coning.tilt_rad * kDegPerRad},
          {"azimuth_deg", coning.azimuth_rad * kDegPerRad}};
}

/// Returns the number of received edges with that damage.
std::int64_t count_of(Damage damage, const ReceivedPass& pass) {
  return std::count_if(pass.pulses.begin(), pass.pulses.end(),
                       [damage](const ReceivedPulse& pulse) { return pulse.damage == damage; });
}

/// Returns the axis (ra_deg, dec_deg), rpm at the start and its drift wdot (rad/s^2), number of
/// revolutions; the numbers of edges missing, spoilt, spurious, doubled or hit by interference;
/// bad_edges as [t_tai_ns, channel, damage]; sun_angle_deg, earth_angle_deg and rho_deg (of the
/// spherical Earth) at the start; where there is any, nutation (half_angle_deg, inertia_ratio,
/// period_s at the start, phase_deg) and coning (tilt_deg, azimuth_deg).
/// @return NoCoverage where the orbit has no state at the start.
Expected<nlohmann::ordered_json> spin_truth(const SpinTruth& truth, const Orbit& orbit,
                                            const ReceivedSpin& spin) {
  const auto state = orbit.at(truth.start);
  if (!state) {
    return Unexpected{state.error()};
  }
  const ReceivedPass& pass = spin.pass;
  const Eigen::Vector3d& axis = truth.motion.axis_icrf;
  const Eigen::Vector3d& position = state->position_icrf_km;
  const Eigen::Vector3d sun = ApparentSun{}.direction_icrf(truth.start, *state);
  const auto [ra_deg, dec_deg] = place_deg(axis);
  nlohmann::ordered_json json = {
      {"ra_deg", ra_deg},
      {"dec_deg", dec_deg},
      {"rpm", truth.motion.rate_rad_s * kRpmPerRad_s},
      {"wdot", truth.motion.rate_drift_rad_s2},
      {"revolutions", spin.revolutions},
      {"missing", pass.missing},
      {"spoilt", count_of(Damage::Spoilt, pass)},
      {"spurious", count_of(Damage::Spurious, pass)},
      {"doubled", count_of(Damage::Doubled, pass)},
      {"interference", count_of(Damage::Interference, pass)},
      {"sun_angle_deg", angle_between_rad(axis, sun) * kDegPerRad},
      {"earth_angle_deg", angle_between_rad(axis, -position) * kDegPerRad},
      {"rho_deg", std::asin(truth.horizon.equatorial_km / position.norm()) * kDegPerRad},
      {"bad_edges", bad_edges(pass)}};
  if (truth.motion.nutation.half_angle_rad > 0.0) {
    json["nutation"] = nutation(truth.motion);
  }
  if (truth.motion.coning.tilt_rad > 0.0) {
    json["coning"] = coning(truth.motion.coning);
  }
  return json;
}

std::vector<Counted> faults_of(const ReceivedPass& pass) {
  std::vector<Counted> faults = {{"missing", pass.missing}};
  for (const Damage damage :
       {Damage::Spoilt, Damage::Spurious, Damage::Doubled, Damage::Interference}) {
    faults.push_back({name_of(damage), count_of(damage, pass)});
  }
  return faults;
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const SpinScenario& flight,
                                    Progress progress) {
  const auto spin = received(scenario, flight, progress);
  if (!spin) {
    return Unexpected{spin.error()};
  }
  auto truth = spin_truth(flight.truth, scenario.orbit, *spin);
  if (!truth) {
    return Unexpected{std::move(truth.error())};
  }
  return SimulatedPass{.kinds = kinds_of(flight.telemetry),
                       .telemetry = telemetry_of(flight.telemetry, spin->pass),
                       .mission_toml = scenario.mission_toml,
                       .truth = std::move(*truth),
                       .made = {{"revolutions", spin->revolutions},
                                {"edges", static_cast<std::int64_t>(spin->pass.pulses.size())}},
                       .faults = faults_of(spin->pass)};
}

}  // namespace spindrift
