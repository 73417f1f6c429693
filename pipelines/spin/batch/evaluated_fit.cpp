#include "pipelines/spin/batch/evaluated_fit.h"

#include "pipelines/spin/batch/pass_nutation.h"

namespace spindrift {

double EvaluatedFit::excess_noise() const {
  return information.excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()) +
                                  kNutationUnknowns * static_cast<int>(fit.state.nutation.size()));
}

double EvaluatedFit::misfit() const { return information.misfit(); }

Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated) {
  return fit(model, edges, start, estimated).map([&](const BatchFit& found) {
    return EvaluatedFit{.fit = found,
                        .estimated = estimated,
                        .information = less_nutation(information_of(model, edges, found.state),
                                                     model, edges, found.state),
                        .nutation = {}};
  });
}

}  // namespace spindrift
