#include "tests/support/recorded_pass.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "pipelines/ephemeris/oem.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing {
namespace {

std::string text_in(const std::filesystem::path& path) {
  std::ifstream file{path};
  file.exceptions(std::ios::failbit);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<Pulse> pulses_in(const std::string& csv) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  std::vector<Pulse> pulses;
  while (std::getline(lines, line)) {
    const auto comma = line.find(',');
    const auto end = line.find_last_not_of('\r') + 1;
    pulses.push_back(
        {.t = tai_from_ns(std::stoll(line.substr(0, comma))),
         .channel = pulse_channel_from(std::string_view{line}.substr(comma + 1, end - comma - 1))
                        .value()});
  }
  return pulses;
}

std::vector<CodedFrame> frames_in(const std::string& csv) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  std::vector<CodedFrame> frames;
  while (std::getline(lines, line)) {
    std::istringstream fields{line};
    std::string field;
    const auto interval_s = [&]() -> std::optional<double> {
      std::getline(fields, field, ',');
      return field.empty() ? std::nullopt : std::optional{std::stod(field)};
    };
    std::getline(fields, field, ',');
    CodedFrame frame{.t = tai_from_ns(std::stoll(field)), .period_s = interval_s(), .delay_s = {}};
    std::generate(frame.delay_s.begin() + 1, frame.delay_s.end(), interval_s);
    frames.push_back(frame);
  }
  return frames;
}

std::set<Pulse> bad_edges_in(const nlohmann::json& truth) {
  std::set<Pulse> bad;
  for (const auto& edge : truth.value("bad_edges", nlohmann::json::array())) {
    bad.insert({.t = tai_from_ns(edge.at(0).get<std::int64_t>()),
                .channel = pulse_channel_from(edge.at(1).get<std::string>()).value()});
  }
  return bad;
}

SpinConfig config_in(const toml::table& mission) {
  const toml::node_view spin = mission["spin"];
  const auto number = [](const auto& node) { return node.template value<double>().value(); };
  const auto infrared = [&](const auto& node) {
    return InfraredSensor{.mount_angle_rad = number(node["mount_angle_deg"]) * kRadPerDeg,
                          .azimuth_rad = number(node["azimuth_deg"]) * kRadPerDeg};
  };
  return {.sun_sensor = {.slit_cant_rad = number(spin["sun_sensor"]["slit_cant_deg"]) * kRadPerDeg,
                         .slit_separation_rad =
                             number(spin["sun_sensor"]["slit_separation_deg"]) * kRadPerDeg},
          .north = infrared(spin["ir"]["north"]),
          .south = infrared(spin["ir"]["south"]),
          .noise = {.sun_s = number(spin["noise"]["sun_pulse_s"]),
                    .infrared_s = number(spin["noise"]["ir_pulse_s"])},
          .horizon = {.model = spin["horizon"]["model"].value<std::string>() == "ellipsoid"
                                   ? HorizonModel::Ellipsoid
                                   : HorizonModel::Sphere,
                      .co2_altitude_km = number(spin["horizon"]["co2_altitude_km"])},
          .screening = {},
          .geometry = {},
          .prior = {}};
}

}  // namespace

RecordedPass recorded_pass(const std::string& name) {
  const std::filesystem::path folder = recorded_passes() / name;
  const auto truth = nlohmann::json::parse(text_in(folder / "truth.json"));
  const bool coded = std::filesystem::exists(folder / "coded.csv");
  return {
      .config = config_in(toml::parse(text_in(folder / "mission.toml"))),
      .orbit = Orbit{parse_oem(text_in(folder / "orbit.oem")).value()},
      .pulses = coded ? std::vector<Pulse>{} : pulses_in(text_in(folder / "pulses.csv")),
      .frames = coded ? frames_in(text_in(folder / "coded.csv")) : std::vector<CodedFrame>{},
      .bad_edges = bad_edges_in(truth),
      .true_axis_icrf = direction_icrf({.ra_rad = truth.at("ra_deg").get<double>() * kRadPerDeg,
                                        .dec_rad = truth.at("dec_deg").get<double>() * kRadPerDeg}),
      .true_rate_rad_s = truth.at("rpm").get<double>() * 2.0 * std::numbers::pi / 60.0};
}

}  // namespace spindrift::testing
