#include "services/simulation/spin_truth.h"

#include <algorithm>
#include <cmath>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "services/base/degrees.h"

namespace spindrift {
namespace {

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

}  // namespace

std::int64_t count_of(Damage damage, const ReceivedPass& pass) {
  return std::count_if(pass.pulses.begin(), pass.pulses.end(),
                       [damage](const ReceivedPulse& pulse) { return pulse.damage == damage; });
}

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

}  // namespace spindrift
