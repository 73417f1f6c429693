/// @file
/// Free nutation of a pass: looked for stretch by stretch in what an even spin leaves of the edges,
/// and what it takes of their information.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/nutation/nutation.h"

namespace spindrift {

struct PassNutation {
  std::vector<NutationStretch> stretches;  ///< Where it was found: what a fit begins with.
  /// Of the last of these; else of the last stretch of the pass. Empty where the edges do not
  /// suffice to look.
  std::optional<NutationSearch> last;
};

/// @param edges In order of time.
/// @param state The best without nutation; what it has of it is put aside.
PassNutation find_pass_nutation(const PassModel& model, std::span<const PassEdge> edges,
                                SpinState state);

/// Half-angle, growth, period and lean as the stretch has them, with the sigmas of the search.
FoundNutation as_fitted(const FoundNutation& found, const PassModel& model, const SpinState& state);

/// What is left of the information on motion and biases, as the nutation of each stretch is
/// unknown.
/// @param information Of the same state, were it known.
PassInformation less_nutation(PassInformation information, const PassModel& model,
                              std::span<const PassEdge> edges, const SpinState& state);

}  // namespace spindrift
