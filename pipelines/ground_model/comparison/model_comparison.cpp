#include "pipelines/ground_model/comparison/model_comparison.h"

#include <utility>

namespace spindrift {

ModelSpan span_of(const GroundModel& model) {
  if (const auto* const spin = std::get_if<SpinModel>(&model)) {
    const ModelRevolution& last = spin->revolutions.back();
    return {.from = spin->start, .to = shifted(spin->start, last.t_s + last.period_s)};
  }
  const auto& body = std::get<ThreeAxisModel>(model);
  return {.from = body.start, .to = shifted(body.start, body.motion.end_s())};
}

ModelComparison::Comparison ModelComparison::comparison_with(const GroundModel& model) {
  if (const auto* const spin = std::get_if<SpinModel>(&model)) {
    return SpinComparison{*spin};
  }
  return ThreeAxisComparison{std::get<ThreeAxisModel>(model)};
}

std::vector<ComparedChannel> ModelComparison::channels_of(const Comparison& comparison) {
  return std::visit([](const auto& is) { return is.channels(); }, comparison);
}

ModelComparison::ModelComparison(std::shared_ptr<const GroundModel> model, double band_sigmas)
    : model_{std::move(model)},
      comparison_{comparison_with(*model_)},
      watch_{channels_of(comparison_), band_sigmas} {}

ModelComparison::Compared ModelComparison::finish() {
  auto* const spin = std::get_if<SpinComparison>(&comparison_);
  return spin == nullptr ? Compared{} : judged(spin->finish());
}

ModelComparison::Compared ModelComparison::judged(std::vector<ComparedSample> samples) {
  Compared compared{.samples = std::move(samples), .changes = {}};
  for (const ComparedSample& sample : compared.samples) {
    add(watch_.evaluate(sample), compared.changes);
  }
  return compared;
}

}  // namespace spindrift
