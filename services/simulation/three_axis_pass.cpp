#include "services/simulation/three_axis_pass.h"

#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/telemetry/time_order.h"

namespace spindrift {
namespace {

using nlohmann::ordered_json;

ordered_json elements_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// Adds a kind of telemetry that the spacecraft has a sensor for.
template <class Value>
void append(const std::vector<Value>& values, SimulatedPass& pass) {
  pass.kinds.emplace_back(Kind<Value>{});
  for (const Value& value : values) {
    pass.telemetry.of<Value>().push_back({.place = {}, .value = value});
  }
  pass.made.push_back({Telemetry<Value>::kPlural, static_cast<std::int64_t>(values.size())});
}

ordered_json true_history(const Scenario& scenario, const BodyMotion& motion) {
  constexpr double kStep_s = 10.0;
  ordered_json history = ordered_json::array();
  for (int i = 0; kStep_s * i <= scenario.duration_s; ++i) {
    const BodyState body = motion.at(kStep_s * i);
    const Eigen::Quaterniond& q = body.q_icrf_body;
    const Eigen::Vector3d rate_deg_s = kDegPerRad * body.rate_body_rad_s;
    history.push_back({tai_ns(shifted(scenario.start, kStep_s * i)), q.x(), q.y(), q.z(), q.w(),
                       rate_deg_s.x(), rate_deg_s.y(), rate_deg_s.z()});
  }
  return history;
}

}  // namespace

Expected<ordered_json> true_state(const Scenario& scenario, const BodyMotion& motion, double t_s) {
  const TaiTime t = shifted(scenario.start, t_s);
  return scenario.orbit.at(t).map([&](const OrbitState& spacecraft) {
    const BodyState body = motion.at(t_s);
    const Eigen::Quaterniond& q = body.q_icrf_body;
    const Eigen::Vector3d minus_z = q * -Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d sun_icrf = ApparentSun{}.direction_icrf(t, spacecraft);
    return ordered_json{{"t_tai_ns", tai_ns(t)},
                        {"q_icrf_body_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                        {"w_body_deg_s", elements_of(kDegPerRad * body.rate_body_rad_s)},
                        {"sun_off_deg", kDegPerRad * angle_between_rad(minus_z, sun_icrf)}};
  });
}

Expected<ordered_json> start_and_end(const Scenario& scenario, const BodyMotion& motion) {
  return true_state(scenario, motion, 0.0).and_then([&](ordered_json&& start) {
    return true_state(scenario, motion, scenario.duration_s).map([&](ordered_json&& end) {
      return ordered_json{{"start", std::move(start)},
                          {"end", std::move(end)},
                          {"history", true_history(scenario, motion)}};
    });
  });
}

SimulatedPass three_axis_pass(const ThreeAxisSensors& sensors, FlownBody flown, ordered_json truth,
                              std::string mission_toml) {
  const ThreeAxisTelemetry& received = flown.telemetry;
  truth["gyro_bias_deg_s"] = elements_of(kDegPerRad * flown.bias_rad_s);
  truth["missing"] = received.missing;
  truth["sun_outliers"] = ordered_json::array();
  for (const TaiTime t : received.sun_outliers) {
    truth["sun_outliers"].push_back(tai_ns(t));
  }
  SimulatedPass pass{
      .kinds = {},
      .telemetry = {},
      .mission_toml = std::move(mission_toml),
      .truth = std::move(truth),
      .made = {},
      .faults = {{"missing", received.missing},
                 {"sun outliers", static_cast<std::int64_t>(received.sun_outliers.size())}}};
  if (sensors.gyro) {
    append(received.gyro, pass);
  }
  if (sensors.sun_sensor) {
    append(received.sun, pass);
  }
  if (sensors.star_tracker) {
    append(received.stars, pass);
  }
  if (sensors.magnetometer) {
    append(received.fields, pass);
  }
  put_in_order(pass.telemetry);
  pass.motion = std::move(flown.motion);
  return pass;
}

}  // namespace spindrift
