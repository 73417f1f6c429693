#include "services/scenario/truth_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

nlohmann::json bad_edges(const SimulatedPass& pass) {
  nlohmann::json edges = nlohmann::json::array();
  for (const auto& [pulse, damage] : pass.received.pulses) {
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

}  // namespace

Expected<std::string> truth_text(const Scenario& scenario, const SimulatedPass& pass) {
  const SpinTruth& truth = scenario.truth;
  const auto state = scenario.orbit.at(truth.start);
  if (!state) {
    return Unexpected{{ErrorCode::InvalidConfiguration, state.error().message}};
  }
  const Eigen::Vector3d& axis = truth.motion.axis_icrf;
  const Eigen::Vector3d& position = state->position_icrf_km;
  const Eigen::Vector3d sun = ApparentSun{}.direction_icrf(truth.start, *state);
  const auto [ra_deg, dec_deg] = place_deg(axis);
  nlohmann::ordered_json json = {
      {"ra_deg", ra_deg},
      {"dec_deg", dec_deg},
      {"rpm", truth.motion.rate_rad_s * kRpmPerRad_s},
      {"wdot", truth.motion.rate_drift_rad_s2},
      {"revolutions", pass.revolutions},
      {"missing", pass.received.missing},
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
  return json.dump(1) + '\n';
}

}  // namespace spindrift
