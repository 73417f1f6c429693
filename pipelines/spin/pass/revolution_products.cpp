#include "pipelines/spin/pass/revolution_products.h"

#include <optional>

#include "pipelines/spin/measurement/edge_use.h"

namespace spindrift {
namespace {

std::vector<Verdict> verdicts_on(const Revolution& revolution,
                                 const RevolutionMeasurements& measured) {
  std::vector<Verdict> verdicts;
  if (const auto& period = revolution.period_candidate) {
    verdicts.push_back({.quantity = SpinQuantity::Period, .rejected_by = period->rejected_by});
  }
  for (const SpinQuantity quantity : kMeasuredAngles) {
    if (const auto value = value_of(measured, quantity)) {
      verdicts.push_back({.quantity = quantity, .rejected_by = value->rejected_by});
    }
  }
  return verdicts;
}

SpinMeasurement measurement_of(const Revolution& revolution, const RevolutionMeasurements& measured,
                               const Verdict& verdict) {
  SpinMeasurement product{.revolution = revolution.number,
                          .quantity = verdict.quantity,
                          .value = 0.0,
                          .sigma = 0.0,
                          .rejected_by = verdict.rejected_by};
  if (verdict.quantity == SpinQuantity::Period) {
    product.value = revolution.period_candidate->period_s;
    product.sigma = revolution.period_candidate->sigma_s;
    product.said = revolution.period_candidate->said;
  } else {
    const Measured value = *value_of(measured, verdict.quantity);
    product.value = value.value_rad;
    product.sigma = value.sigma_rad;
    product.said = value.said;
  }
  return product;
}

}  // namespace

std::vector<SpinProduct> revolution_products(const SpinConfig& config, const Revolution& revolution,
                                             const RevolutionMeasurements& measured) {
  std::vector<SpinProduct> products;
  if (measured.t_sun1) {
    products.emplace_back(RevolutionProduct{.revolution = revolution.number,
                                            .t_sun1 = *measured.t_sun1,
                                            .period_s = revolution.period.period_s});
  }
  const std::vector<Verdict> verdicts = verdicts_on(revolution, measured);
  for (const Verdict& verdict : verdicts) {
    products.emplace_back(measurement_of(revolution, measured, verdict));
  }
  for (const PulseUse& use : edge_uses(config, revolution, verdicts)) {
    products.emplace_back(use);
  }
  return products;
}

}  // namespace spindrift
