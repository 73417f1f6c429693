#include "services/simulation/three_axis_pass.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/flights/channel_margins.h"
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

/// Returns the truth at `t_s` since the start: t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and
/// sun_off_deg (from -Z to the Sun). @return NoCoverage where the orbit does not reach.
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

/// Returns the truth at start and end and, every ten seconds between them, `history`: t_tai_ns; x,
/// y, z, w of q_icrf_body; body rates in deg/s. @return NoCoverage as for `true_state`.
Expected<ordered_json> start_and_end(const Scenario& scenario, const BodyMotion& motion) {
  return true_state(scenario, motion, 0.0).and_then([&](ordered_json&& start) {
    return true_state(scenario, motion, scenario.duration_s).map([&](ordered_json&& end) {
      return ordered_json{{"start", std::move(start)},
                          {"end", std::move(end)},
                          {"history", true_history(scenario, motion)}};
    });
  });
}

/// @param truth Truth to which gyro_bias_deg_s, missing and sun_outliers are added.
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

/// Returns T1 to T4, in seconds since the start.
std::array<double, 4> events_s(const SeparationScenario& flight) {
  return {0.0, flight.truth.control_on_s, flight.truth.acquisition_s, flight.first_star_fix_s};
}

Expected<ordered_json> truth_of(const Scenario& scenario, const SeparationScenario& flight,
                                const BodyMotion& motion) {
  ordered_json truth;
  int number = 1;
  for (const double t_s : events_s(flight)) {
    auto event = true_state(scenario, motion, t_s);
    if (!event) {
      return Unexpected{std::move(event.error())};
    }
    truth[fmt::format("T{}", number++)] = std::move(*event);
  }
  return truth;
}

std::string reconstruction_text(const Scenario& scenario, const SeparationScenario& flight,
                                const std::optional<Euler312>& told) {
  std::string text = "\n[reconstruction]\n";
  if (!disturbs(flight.truth.body.disturbances)) {
    text += "disturbance_deg_s2 = 0\n";
  }
  int number = 1;
  for (const double t_s : events_s(flight)) {
    text += fmt::format("t{}_tai_ns = {}\n", number++, tai_ns(shifted(scenario.start, t_s)));
  }
  if (told) {
    text +=
        fmt::format("\n[reconstruction.launcher]\neuler312_deg = [{}, {}, {}]\nsigma_deg = {}\n",
                    told->phi_rad * kDegPerRad, told->theta_rad * kDegPerRad,
                    told->psi_rad * kDegPerRad, flight.launcher->sigma_rad * kDegPerRad);
  }
  return text;
}

ordered_json number_or_null(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

void add_outcome(const OrientationOutcome& outcome, ordered_json& truth) {
  truth["pointing_s"] = number_or_null(outcome.pointing_s);
  truth["settled_s"] = number_or_null(outcome.settled_s);
  truth["last_off_deg"] = kDegPerRad * outcome.last_off_rad;
  truth["wheel_nms_most"] = outcome.most_nms;
  truth["wheel_rpm_most"] = kRpmPerRad_s * outcome.most_rad_s;
}

void add_outcome(const RescueOutcome& outcome, ordered_json& truth) {
  truth["lost_s"] = number_or_null(outcome.lost_s);
  truth["control_s"] = number_or_null(outcome.controlled_s);
  truth["reached_s"] = number_or_null(outcome.reached_s);
  truth["filter_off_deg"] = outcome.error_at_safe_rad
                                ? ordered_json(kDegPerRad * *outcome.error_at_safe_rad)
                                : ordered_json(nullptr);
  truth["last_off_deg"] = kDegPerRad * outcome.last_off_rad;
}

/// Adds the margins of the loops as flown, about X, Y and Z.
Expected<void> add_margins(const OrientationTruth& flight, ordered_json& truth) {
  return channel_margins(flight).map([&](const std::array<ChannelMargins, 3>& channels) {
    for (const ChannelMargins& channel : channels) {
      const LoopMargins& margins = channel.flown_margins;
      truth["phase_margin_deg"].push_back(kDegPerRad * margins.phase_rad);
      truth["gain_margin_db"].push_back(20.0 * std::log10(*margins.gain));
      truth["crossover_rad_s"].push_back(margins.crossover_rad_s);
    }
  });
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownSeparation&& separation) {
    return truth_of(scenario, flight, separation.body.motion).map([&](ordered_json&& truth) {
      return three_axis_pass(
          flight.view.sensors, std::move(separation.body), std::move(truth),
          scenario.mission_toml + reconstruction_text(scenario, flight, separation.told));
    });
  });
}

Expected<SimulatedPass> played_pass(const Scenario& scenario, const TumblingScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownBody&& body) {
    return start_and_end(scenario, body.motion).map([&](ordered_json&& truth) {
      return three_axis_pass(flight.view.sensors, std::move(body), std::move(truth),
                             scenario.mission_toml);
    });
  });
}

Expected<SimulatedPass> played_pass(const Scenario& scenario, const OrientationScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownOrientation&& orientation) {
    auto truth = start_and_end(scenario, orientation.body.motion);
    if (!truth) {
      return Expected<SimulatedPass>{Unexpected{std::move(truth.error())}};
    }
    add_outcome(orientation.outcome, *truth);
    return add_margins(flight.truth, *truth).map([&] {
      SimulatedPass pass = three_axis_pass(flight.view.sensors, std::move(orientation.body),
                                           *std::move(truth), scenario.mission_toml);
      pass.control = std::move(orientation.record);
      return pass;
    });
  });
}

Expected<SimulatedPass> played_pass(const Scenario& scenario, const RescueScenario& flight) {
  return flown(flight, scenario.orbit).and_then([&](FlownRescue&& rescue) {
    return start_and_end(scenario, rescue.body.motion).map([&](ordered_json&& truth) {
      add_outcome(rescue.outcome, truth);
      return three_axis_pass(flight.view.sensors, std::move(rescue.body), std::move(truth),
                             scenario.mission_toml);
    });
  });
}

}  // namespace spindrift
