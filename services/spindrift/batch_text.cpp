#include "services/spindrift/batch_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "pipelines/time/utc.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

struct Readable {
  double value;
  double sigma;
  const char* unit;
};

Readable readable(const BiasEstimate& bias) {
  const bool is_angle = prior_of(bias.bias).is_angle;
  const double to_unit = is_angle ? kDegPerRad : 1.0;
  return {.value = bias.value * to_unit,
          .sigma = bias.sigma * to_unit,
          .unit = is_angle ? "deg" : "km"};
}

std::string nutation_text(const std::optional<NutationSearch>& search) {
  if (!search) {
    return "  nutation     not looked for: too few edges\n";
  }
  if (!search->found) {
    return fmt::format("  nutation     none above {:.3f} deg\n",
                       search->detectable_rad * kDegPerRad);
  }
  const FoundNutation& found = *search->found;
  return fmt::format("  nutation     {:.4f} +/- {:.4f} deg, period {:.4f} +/- {:.4f} s\n",
                     found.half_angle_rad.value * kDegPerRad,
                     found.half_angle_rad.sigma * kDegPerRad, found.period_s.value,
                     found.period_s.sigma);
}

nlohmann::json to_json(const std::optional<NutationSearch>& search) {
  if (!search) {
    return nullptr;
  }
  nlohmann::json json{{"detected", search->found.has_value()},
                      {"detectable_deg", search->detectable_rad * kDegPerRad}};
  if (const auto& found = search->found) {
    json["half_angle_deg"] = found->half_angle_rad.value * kDegPerRad;
    json["half_angle_sigma_deg"] = found->half_angle_rad.sigma * kDegPerRad;
    json["period_s"] = found->period_s.value;
    json["period_sigma_s"] = found->period_s.sigma;
  }
  return json;
}

}  // namespace

std::string to_text(const BatchSolution& solution) {
  std::string text = fmt::format(
      "  bound        {:.4f} deg (Cramer-Rao), {} edges, {} outliers, noise x {:.2f}\n",
      solution.bound_rad * kDegPerRad, solution.edges, solution.outliers, solution.noise);
  text += nutation_text(solution.nutation);
  std::string_view heading = "biases";
  for (const BiasEstimate& bias : solution.biases) {
    const Readable shown = readable(bias);
    text += bias.observable
                ? fmt::format("  {:<13}{:<18}{:+9.4f} +/- {:.4f} {}\n", heading,
                              prior_of(bias.bias).name, shown.value, shown.sigma, shown.unit)
                : fmt::format("  {:<13}{:<18}not observable\n", heading, prior_of(bias.bias).name);
    heading = "";
  }
  for (const std::string& direction : solution.undetermined) {
    text += fmt::format("               {}\n", direction);
  }
  return text;
}

nlohmann::json to_json(const BatchSolution& solution) {
  nlohmann::json biases = nlohmann::json::object();
  for (const BiasEstimate& bias : solution.biases) {
    const Readable shown = readable(bias);
    biases[std::string{prior_of(bias.bias).name}] = {{"value", shown.value},
                                                     {"sigma", shown.sigma},
                                                     {"unit", shown.unit},
                                                     {"observable", bias.observable}};
  }
  nlohmann::json json{{"bound_deg", solution.bound_rad * kDegPerRad},
                      {"edges", solution.edges},
                      {"outliers", solution.outliers},
                      {"noise", solution.noise},
                      {"iterations", solution.iterations},
                      {"singular_values", solution.singular_values},
                      {"undetermined", solution.undetermined},
                      {"biases", biases},
                      {"nutation", to_json(solution.nutation)},
                      {"changed_utc", nullptr}};
  if (solution.changed) {
    json["changed_utc"] = format_utc(*solution.changed);
  }
  return json;
}

}  // namespace spindrift
