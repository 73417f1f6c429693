#include "services/simulation/spin_scenario.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/spin_rate.h"
#include "services/mission/mission_spin.h"
#include "services/mission/values.h"
#include "services/simulation/silences.h"

namespace spindrift {
namespace {

/// Checks that an angle of the mission file plus the offset of the truth stays an allowed one.
void check_offset(TomlDocument& document, std::string_view key, std::string_view offset_key,
                  double below_deg) {
  const auto angle_deg = value_if<double>(document.values, key);
  const auto offset_deg = value_if<double>(document.values, offset_key);
  if (angle_deg && offset_deg &&
      !(*angle_deg + *offset_deg > 0.0 && *angle_deg + *offset_deg < below_deg)) {
    add_problem(document, offset_key,
                fmt::format("{} = {}: with {} = {} must lie in (0, {}) deg", offset_key,
                            *offset_deg, key, *angle_deg, below_deg));
  }
}

void check_sensors(TomlDocument& document) {
  check_offset(document, "spin.sun_sensor.slit_cant_deg", "truth.sun_sensor.slit_cant_offset_deg",
               90.0);
  for (const std::string side : {"north", "south"}) {
    check_offset(document, "spin.ir." + side + ".mount_angle_deg",
                 "truth.ir." + side + ".mount_angle_offset_deg", 180.0);
    if (document.table.at_path("truth.ir." + side) && !document.table.at_path("spin.ir." + side)) {
      add_problem(document, "truth.ir." + side,
                  fmt::format("[truth.ir.{0}]: there is no [spin.ir.{0}]", side));
    }
  }
}

void check_rate(TomlDocument& document) {
  const auto rate_rpm = value_if<double>(document.values, "attitude.rate_rpm");
  const auto drift_rpm_h = value_if<double>(document.values, "attitude.rate_drift_rpm_h");
  const auto duration_s = value_if<double>(document.values, "pass.duration_s");
  if (!rate_rpm || !drift_rpm_h || !duration_s) {
    return;
  }
  const double last_rpm = *rate_rpm + *drift_rpm_h * *duration_s / kHour_s;
  if (!(last_rpm >= kSlowestSpin_rpm && last_rpm <= kFastestSpin_rpm)) {
    add_problem(document, "attitude.rate_drift_rpm_h",
                fmt::format("attitude.rate_drift_rpm_h = {}: the rate ends at {:.3f} rpm: must lie "
                            "in [{}, {}] rpm",
                            *drift_rpm_h, last_rpm, kSlowestSpin_rpm, kFastestSpin_rpm));
  }
}

/// Checks that nutation grows to no larger half-angle than is allowed at the start.
void check_growth(TomlDocument& document) {
  const auto half_angle_deg = value_if<double>(document.values, "attitude.nutation.half_angle_deg");
  const auto growth_per_h = value_if<double>(document.values, "attitude.nutation.growth_per_h");
  const auto duration_s = value_if<double>(document.values, "pass.duration_s");
  if (!half_angle_deg || !growth_per_h || !duration_s) {
    return;
  }
  const double last_deg = *half_angle_deg * std::exp(*growth_per_h * *duration_s / kHour_s);
  constexpr double kMost_deg = 10.0;
  if (!(last_deg <= kMost_deg)) {
    add_problem(
        document, "attitude.nutation.growth_per_h",
        fmt::format("attitude.nutation.growth_per_h = {}: the half-angle ends at {:.3f} deg: "
                    "must be {} deg at most",
                    *growth_per_h, last_deg, kMost_deg));
  }
}

Nutation nutation_of(const TomlValues& values) {
  const auto half_angle_deg = value_if<double>(values, "attitude.nutation.half_angle_deg");
  return half_angle_deg
             ? Nutation{.half_angle_rad = *half_angle_deg / kDegPerRad,
                        .inertia_ratio = number(values, "attitude.nutation.inertia_ratio"),
                        .first_azimuth_rad = radians(values, "attitude.nutation.phase_deg"),
                        .growth_per_s = number(values, "attitude.nutation.growth_per_h") / kHour_s}
             : Nutation{};
}

Coning coning_of(const TomlValues& values) {
  const auto tilt_deg = value_if<double>(values, "attitude.coning.tilt_deg");
  return tilt_deg ? Coning{.tilt_rad = *tilt_deg / kDegPerRad,
                           .azimuth_rad = radians(values, "attitude.coning.azimuth_deg")}
                  : Coning{};
}

SpinMotion motion_of(const TomlValues& values) {
  const double rad_s_per_rpm = 1.0 / kRpmPerRad_s;
  return {
      .axis_icrf = direction_icrf({.ra_rad = radians(values, "attitude.ra_deg"),
                                   .dec_rad = radians(values, "attitude.dec_deg")}),
      .rate_rad_s = number(values, "attitude.rate_rpm") * rad_s_per_rpm,
      .rate_drift_rad_s2 = number(values, "attitude.rate_drift_rpm_h") * rad_s_per_rpm / kHour_s,
      .first_azimuth_rad = radians(values, "attitude.azimuth_deg"),
      .nutation = nutation_of(values),
      .coning = coning_of(values)};
}

std::optional<TrueInfrared> true_infrared(const TomlValues& values,
                                          const std::optional<InfraredSensor>& said,
                                          const std::string& side) {
  if (!said) {
    return std::nullopt;
  }
  const std::string table = "truth.ir." + side;
  return TrueInfrared{
      .mount_angle_rad = said->mount_angle_rad + radians(values, table + ".mount_angle_offset_deg"),
      .azimuth_rad = said->azimuth_rad + radians(values, table + ".azimuth_offset_deg"),
      .chord_excess_rad = radians(values, table + ".chord_excess_deg")};
}

Horizon true_horizon(const TomlValues& values, Horizon said) {
  if (const auto model = value_if<std::string>(values, "truth.horizon.model")) {
    said.model = *model == "sphere" ? HorizonModel::Sphere : HorizonModel::Ellipsoid;
  }
  said.co2_altitude_km =
      value_if<double>(values, "truth.horizon.co2_altitude_km").value_or(said.co2_altitude_km);
  return said;
}

SpinTruth truth_of(const TomlValues& values, const SpinConfig& said, TaiTime start) {
  const SunSensor sun_sensor = {
      .slit_cant_rad =
          said.sun_sensor.slit_cant_rad + radians(values, "truth.sun_sensor.slit_cant_offset_deg"),
      .slit_separation_rad = said.sun_sensor.slit_separation_rad +
                             radians(values, "truth.sun_sensor.slit_separation_offset_deg")};
  return {.start = start,
          .motion = motion_of(values),
          .sun_sensor = sun_sensor,
          .north = true_infrared(values, said.north, "north"),
          .south = true_infrared(values, said.south, "south"),
          .horizon = infrared_horizon(true_horizon(values, said.horizon), earth_pole_icrf(start))};
}

ChannelFaults channel_faults(const TomlValues& values, std::string_view channel) {
  const std::string table = fmt::format("faults.channel.{}", channel);
  const auto probability = [&](std::string_view fault) {
    return value_if<double>(values, fmt::format("{}.{}", table, fault))
        .value_or(number(values, fmt::format("faults.{}", fault)));
  };
  return {.lost = probability("lost"),
          .spoilt = probability("spoilt"),
          .doubled = probability("doubled"),
          .spurious = probability("spurious"),
          .dead = value_of<bool>(values, table + ".dead")};
}

PulseLink link_of(const TomlValues& values, const PulseNoise& said) {
  PulseLink link = {
      .seed = static_cast<std::uint64_t>(value_of<std::int64_t>(values, "pass.seed")),
      .noise = {.sun_s = value_if<double>(values, "truth.noise.sun_pulse_s").value_or(said.sun_s),
                .infrared_s =
                    value_if<double>(values, "truth.noise.ir_pulse_s").value_or(said.infrared_s)},
      .channels = {},
      .spoilt_min_s = number(values, "faults.spoilt_min_s"),
      .spoilt_max_s = number(values, "faults.spoilt_max_s"),
      .doubled_max_s = number(values, "faults.doubled_max_s"),
      .interference_s = number(values, "faults.interference_s"),
      .silences = silences_of(values, "faults.silence")};
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    link.channels.at(channel) = channel_faults(values, kPulseChannelNames.at(channel));
  }
  return link;
}

SimulatedTelemetry telemetry_of(const TomlValues& values) {
  const auto kind = value_of<std::string>(values, "telemetry.kind");
  return {.pulses = kind != "coded",
          .coded = kind != "pulses",
          .coded_resolution_s = number(values, "telemetry.coded_resolution_s")};
}

}  // namespace

void check_spin_scenario(TomlDocument& document) {
  check_sensors(document);
  check_rate(document);
  check_growth(document);
}

SpinScenario spin_scenario(const TomlValues& values, TaiTime start) {
  const SpinConfig said = spin_config(values);
  return {.truth = truth_of(values, said, start),
          .link = link_of(values, said.noise),
          .telemetry = telemetry_of(values)};
}

}  // namespace spindrift
