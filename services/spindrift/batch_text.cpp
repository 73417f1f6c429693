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

}  // namespace

std::string to_text(const BatchSolution& solution) {
  std::string text = fmt::format(
      "  bound        {:.4f} deg (Cramer-Rao), {} edges, {} outliers, noise x {:.2f}\n",
      solution.bound_rad * kDegPerRad, solution.edges, solution.outliers, solution.noise);
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
                      {"changed_utc", nullptr}};
  if (solution.changed) {
    json["changed_utc"] = format_utc(*solution.changed);
  }
  return json;
}

}  // namespace spindrift
