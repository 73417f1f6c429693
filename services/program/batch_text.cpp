#include "services/program/batch_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "pipelines/time/utc.h"
#include "services/base/bias_words.h"
#include "services/base/decimals.h"
#include "services/base/degrees.h"

namespace spindrift {
namespace {

struct ReadableBias {
  double value;
  double sigma;
  const char* unit;
};

ReadableBias readable(const BiasEstimate& bias) {
  const bool is_angle = range_of(bias.bias).is_angle;
  const double to_unit = is_angle ? kDegPerRad : 1.0;
  return {.value = bias.value * to_unit,
          .sigma = bias.sigma * to_unit,
          .unit = is_angle ? "deg" : "km"};
}

std::string nutation_text(const BatchSolution& solution) {
  const auto& search = solution.nutation;
  if (!search) {
    return "  nutation     not looked for: too few edges\n";
  }
  if (!search->found) {
    return fmt::format("  nutation     none above {} deg\n",
                       to_its_digits(search->detectable_rad * kDegPerRad, 3));
  }
  const FoundNutation& found = *search->found;
  std::string others;
  for (const double other_s : found.other_periods_s) {
    others += fmt::format(" or {:.{}f} s", other_s, decimals_for(found.period_s.sigma, 4));
  }
  return fmt::format(
      "  nutation     {} deg at {}, period {} s{}\n"
      "               grows by {} of it an hour\n",
      with_sigma(found.half_angle_rad.value * kDegPerRad, found.half_angle_rad.sigma * kDegPerRad,
                 4),
      format_utc(solution.nutation_t, 0), with_sigma(found.period_s.value, found.period_s.sigma, 4),
      others,
      signed_with_sigma(found.growth_per_s.value * kHour_s, found.growth_per_s.sigma * kHour_s, 2));
}

std::string coning_text(const ConingEstimate& coning) {
  const auto& [tilt_rad, azimuth_rad, detected, detectable_rad] = coning.verdict;
  return detected
             ? fmt::format(
                   "  coning       {} deg, {} deg behind slit 1\n",
                   with_sigma(tilt_rad * kDegPerRad, coning.tilt_sigma_rad * kDegPerRad, 4),
                   with_sigma(azimuth_rad * kDegPerRad, coning.azimuth_sigma_rad * kDegPerRad, 1))
             : fmt::format("  coning       none above {} deg\n",
                           to_its_digits(detectable_rad * kDegPerRad, 3));
}

nlohmann::json nutation_json(const BatchSolution& solution) {
  const auto& search = solution.nutation;
  if (!search) {
    return nullptr;
  }
  nlohmann::json json{{"detected", search->found.has_value()},
                      {"false_alarm", search->false_alarm},
                      {"detectable_deg", search->detectable_rad * kDegPerRad}};
  if (const auto& found = search->found) {
    json["half_angle_deg"] = found->half_angle_rad.value * kDegPerRad;
    json["half_angle_sigma_deg"] = found->half_angle_rad.sigma * kDegPerRad;
    json["period_s"] = found->period_s.value;
    json["period_sigma_s"] = found->period_s.sigma;
    json["other_periods_s"] = found->other_periods_s;
    json["growth_per_h"] = found->growth_per_s.value * kHour_s;
    json["growth_sigma_per_h"] = found->growth_per_s.sigma * kHour_s;
    json["lean_azimuth_deg"] = found->lean_azimuth_rad.value * kDegPerRad;
    json["lean_azimuth_sigma_deg"] = found->lean_azimuth_rad.sigma * kDegPerRad;
    json["at_utc"] = format_utc(solution.nutation_t);
  }
  return json;
}

nlohmann::json to_json(const ConingEstimate& coning) {
  nlohmann::json json{{"detected", coning.verdict.detected},
                      {"detectable_deg", coning.verdict.detectable_rad * kDegPerRad}};
  if (coning.verdict.detected) {
    json["tilt_deg"] = coning.verdict.tilt_rad * kDegPerRad;
    json["tilt_sigma_deg"] = coning.tilt_sigma_rad * kDegPerRad;
    json["azimuth_deg"] = coning.verdict.azimuth_rad * kDegPerRad;
    json["azimuth_sigma_deg"] = coning.azimuth_sigma_rad * kDegPerRad;
  }
  return json;
}

}  // namespace

std::string to_text(const BatchSolution& solution) {
  std::string text =
      fmt::format("  bound        {} deg (Cramer-Rao), {} edges, {} outliers, noise x {:.2f}\n",
                  to_its_digits(solution.bound_rad * kDegPerRad, 4), solution.edges,
                  solution.outliers, solution.noise);
  text += fmt::format("  noise        {} deg (sigma, were the mission file exact)\n",
                      to_its_digits(noise_sigma_rad(solution.estimate) * kDegPerRad, 4));
  text += fmt::format("  rate drift   {} rpm/h\n",
                      signed_with_sigma(solution.drift_rad_s2 * kRpmPerHourPerRad_s2,
                                        solution.drift_sigma_rad_s2 * kRpmPerHourPerRad_s2, 6));
  text += nutation_text(solution) + coning_text(solution.coning);
  std::string_view heading = "biases";
  for (const BiasEstimate& bias : solution.biases) {
    const ReadableBias shown = readable(bias);
    text += bias.observable
                ? fmt::format("  {:<13}{:<18}{} {}{}\n", heading, range_of(bias.bias).name,
                              signed_with_sigma(shown.value, shown.sigma, 4), shown.unit,
                              bias.estimated ? "" : " (not in the axis)")
                : fmt::format("  {:<13}{:<18}not observable\n", heading, range_of(bias.bias).name);
    heading = "";
  }
  for (const BiasSet& direction : solution.undetermined) {
    text += fmt::format("               {}\n", undetermined_sentence(direction));
  }
  return text;
}

nlohmann::json to_json(const BatchSolution& solution) {
  nlohmann::json biases = nlohmann::json::object();
  for (const BiasEstimate& bias : solution.biases) {
    const ReadableBias shown = readable(bias);
    biases[std::string{range_of(bias.bias).name}] = {
        {"value", bias.observable ? nlohmann::json(shown.value) : nlohmann::json{}},
        {"sigma", shown.sigma},
        {"unit", shown.unit},
        {"observable", bias.observable},
        {"estimated", bias.estimated}};
  }
  nlohmann::json undetermined = nlohmann::json::array();
  for (const BiasSet& direction : solution.undetermined) {
    undetermined.push_back(undetermined_sentence(direction));
  }
  nlohmann::json json{
      {"bound_deg", solution.bound_rad * kDegPerRad},
      {"noise_sigma_deg", noise_sigma_rad(solution.estimate) * kDegPerRad},
      {"consider_sigma_deg", sigma_deg(solution.estimate.covariance_rad2)},
      {"rate_drift_rpm_h", solution.drift_rad_s2 * kRpmPerHourPerRad_s2},
      {"rate_drift_sigma_rpm_h", solution.drift_sigma_rad_s2 * kRpmPerHourPerRad_s2},
      {"edges", solution.edges},
      {"outliers", solution.outliers},
      {"noise", solution.noise},
      {"iterations", solution.iterations},
      {"singular_values", solution.singular_values},
      {"undetermined", undetermined},
      {"biases", biases},
      {"nutation", nutation_json(solution)},
      {"coning", to_json(solution.coning)},
      {"changed_utc", nullptr}};
  if (solution.changed) {
    json["changed_utc"] = format_utc(*solution.changed);
  }
  return json;
}

}  // namespace spindrift
