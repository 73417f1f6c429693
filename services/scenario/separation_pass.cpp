#include "services/scenario/separation_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

using nlohmann::ordered_json;

ordered_json elements_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// T1 to T4, behind the start.
std::array<double, 4> events_s(const SeparationScenario& flight) {
  const SeparationPhases& phases = flight.truth.phases;
  return {0.0, phases.control_on_s, phases.acquisition_s, flight.first_star_fix_s};
}

ordered_json event_of(const BodyState& body, TaiTime t, const OrbitState& spacecraft) {
  const Eigen::Quaterniond& q = body.q_icrf_body;
  const Eigen::Vector3d sun_icrf = ApparentSun{}.direction_icrf(t, spacecraft);
  return {{"t_tai_ns", tai_ns(t)},
          {"q_icrf_body_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"w_body_deg_s", elements_of(kDegPerRad * body.rate_body_rad_s)},
          {"sun_off_deg", kDegPerRad * angle_between_rad(q * -Eigen::Vector3d::UnitZ(), sun_icrf)}};
}

Expected<ordered_json> truth_of(const Scenario& scenario, const SeparationScenario& flight,
                                const FlownSeparation& flown) {
  ordered_json truth;
  int number = 1;
  for (const double t_s : events_s(flight)) {
    const TaiTime t = shifted(scenario.start, t_s);
    const auto spacecraft = scenario.orbit.at(t);
    if (!spacecraft) {
      return Unexpected{spacecraft.error()};
    }
    truth[fmt::format("T{}", number++)] = event_of(flown.motion.at(t_s), t, *spacecraft);
  }
  truth["gyro_bias_deg_s"] = elements_of(kDegPerRad * flown.bias_rad_s);
  truth["missing"] = flown.telemetry.missing;
  truth["sun_outliers"] = ordered_json::array();
  for (const TaiTime t : flown.telemetry.sun_outliers) {
    truth["sun_outliers"].push_back(tai_ns(t));
  }
  return truth;
}

std::string reconstruction_text(const Scenario& scenario, const SeparationScenario& flight,
                                const FlownSeparation& flown) {
  std::string text = "\n[reconstruction]\n";
  int number = 1;
  for (const double t_s : events_s(flight)) {
    text += fmt::format("t{}_tai_ns = {}\n", number++, tai_ns(shifted(scenario.start, t_s)));
  }
  if (const auto& told = flown.told) {
    text +=
        fmt::format("\n[reconstruction.launcher]\neuler312_deg = [{}, {}, {}]\nsigma_deg = {}\n",
                    told->phi_rad * kDegPerRad, told->theta_rad * kDegPerRad,
                    told->psi_rad * kDegPerRad, flight.launcher->sigma_rad * kDegPerRad);
  }
  return text;
}

/// In order of time as files are merged.
void put_in_order(TelemetryValues& all) {
  std::vector<std::pair<TelemetryOrder, std::int64_t*>> places;
  all.for_each([&](auto& of_kind) {
    for (auto& arrived : of_kind) {
      places.emplace_back(order_of(arrived.value), &arrived.arrival);
    }
  });
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    *places[i].second = static_cast<std::int64_t>(i);
  }
}

TelemetryValues telemetry_of(const ThreeAxisTelemetry& telemetry) {
  TelemetryValues all;
  const auto append = [&]<class Value>(const std::vector<Value>& values) {
    for (const Value& value : values) {
      all.of<Value>().push_back({.arrival = 0, .value = value});
    }
  };
  append(telemetry.gyro);
  append(telemetry.sun);
  append(telemetry.stars);
  append(telemetry.fields);
  put_in_order(all);
  return all;
}

template <class Value>
Counted count_of(const TelemetryValues& telemetry) {
  return {Telemetry<Value>::kPlural, static_cast<std::int64_t>(telemetry.of<Value>().size())};
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight) {
  const auto flown_separation = flown(flight, scenario.orbit);
  if (!flown_separation) {
    return Unexpected{flown_separation.error()};
  }
  auto truth = truth_of(scenario, flight, *flown_separation);
  if (!truth) {
    return Unexpected{std::move(truth.error())};
  }
  const ThreeAxisTelemetry& received = flown_separation->telemetry;
  SimulatedPass pass{
      .kinds = {Kind<GyroSample>{}, Kind<StarFix>{}, Kind<SunDirection>{}},
      .telemetry = telemetry_of(received),
      .mission_toml =
          scenario.mission_toml + reconstruction_text(scenario, flight, *flown_separation),
      .truth = std::move(*truth),
      .made = {},
      .faults = {{"missing", received.missing},
                 {"sun outliers", static_cast<std::int64_t>(received.sun_outliers.size())}}};
  pass.made = {count_of<GyroSample>(pass.telemetry), count_of<SunDirection>(pass.telemetry),
               count_of<StarFix>(pass.telemetry)};
  if (flight.sensors.magnetometer) {
    pass.kinds.emplace_back(Kind<MagneticField>{});
    pass.made.push_back(count_of<MagneticField>(pass.telemetry));
  }
  return pass;
}

}  // namespace spindrift
