#include "pipelines/spin/batch/evaluated_fit.h"

#include "pipelines/spin/batch/observability.h"
#include "pipelines/spin/batch/pass_nutation.h"

namespace spindrift {

PassInformation EvaluatedFit::beside_offsets() const {
  if ((offsets_s2.array() == 0.0).all()) {
    return information;
  }
  PassInformation beside = information.less_offsets(offsets_s2);
  const auto step = Observability{beside, estimated}.step(beside, fit.state.biases);
  beside.score += beside.information * step;
  return beside;
}

double EvaluatedFit::excess_noise() const {
  return beside_offsets().excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()) +
                                       kNutationUnknowns *
                                           static_cast<int>(fit.state.nutation.size()));
}

double EvaluatedFit::misfit() const { return information.misfit(); }

Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated) {
  return fit(model, edges, start, estimated).map([&](const BatchFit& found) {
    return EvaluatedFit{.fit = found,
                        .estimated = estimated,
                        .information = less_nutation(information_of(model, edges, found.state),
                                                     model, edges, found.state),
                        .offsets_s2 = offset_prior_s2(model.config().noise),
                        .nutation = {}};
  });
}

}  // namespace spindrift
