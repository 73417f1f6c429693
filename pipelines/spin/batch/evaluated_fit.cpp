#include "pipelines/spin/batch/evaluated_fit.h"

#include <utility>

#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/spin/batch/observability.h"
#include "pipelines/spin/batch/pass_nutation.h"

namespace spindrift {

PassInformation EvaluatedFit::beside(const ConsideredPrior& prior) const {
  if ((prior.array() == 0.0).all()) {
    return information;
  }
  PassInformation beside = information.less_considered(prior);
  const auto step = Observability{beside, estimated}.step(beside, fit.state.biases);
  const auto change = (beside.information * step).eval();
  beside.squares += 2.0 * beside.score.dot(step) + step.dot(change);
  beside.score += change;
  return beside;
}

double EvaluatedFit::excess_noise() const {
  return beside_considered().excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()) +
                                          kNutationUnknowns *
                                              static_cast<int>(fit.state.nutation.size()));
}

double EvaluatedFit::misfit() const {
  return beside(considered_prior(of_alignment(considered))).misfit();
}

EvaluatedFit evaluated(const PassModel& model, std::span<const PassEdge> edges, BatchFit fit,
                       BiasSet estimated) {
  const SpinConfig& config = model.config();
  const SpinAlignment alignment = BiasPriors{model, fit.state}.alignment_beside(estimated);
  PassInformation information =
      less_nutation(information_of(model, edges, fit.state), model, edges, fit.state);
  return {.fit = std::move(fit),
          .estimated = estimated,
          .information = std::move(information),
          .considered = considered_prior(config.noise, alignment),
          .nutation = {}};
}

Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated) {
  return fit(model, edges, start, estimated).map([&](const BatchFit& found) {
    return evaluated(model, edges, found, estimated);
  });
}

}  // namespace spindrift
