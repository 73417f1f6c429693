#include "pipelines/spin/batch/explained.h"

#include "pipelines/spin/batch/pass_nutation.h"

namespace spindrift {

double Explained::excess_noise() const {
  return information.excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()) +
                                  kNutationUnknowns * static_cast<int>(fit.state.nutation.size()));
}

double Explained::misfit() const { return information.misfit(); }

Expected<Explained> explain(const PassModel& model, std::span<const PassEdge> edges,
                            const SpinState& start, BiasSet estimated) {
  return fit(model, edges, start, estimated).map([&](const BatchFit& found) {
    return Explained{.fit = found,
                     .estimated = estimated,
                     .information = less_nutation(information_of(model, edges, found.state), model,
                                                  edges, found.state),
                     .nutation = {}};
  });
}

}  // namespace spindrift
