/// @file
/// A fitted state with some biases estimated, its information and its misfit.

#pragma once

#include <optional>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/batch_fit.h"
#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/nutation/nutation.h"

namespace spindrift {

struct EvaluatedFit {
  BatchFit fit;
  BiasSet estimated;
  PassInformation information;  ///< Information, less what nutation takes.
  /// Prior of the considered parameters, beside the biases; `information` assumes zeros.
  ConsideredPrior considered;
  std::optional<NutationSearch> nutation;

  /// Returns the equations with the considered parameters unknown within the prior, one step nearer
  /// to the best state.
  PassInformation beside(const ConsideredPrior& prior) const;
  PassInformation beside_considered() const { return beside(considered); }
  double excess_noise() const;
  /// Returns the misfit that the mission file's alignment does not explain.
  double misfit() const;
};

/// Returns a state with its equations.
EvaluatedFit evaluated(const PassModel& model, std::span<const PassEdge> edges, BatchFit fit,
                       BiasSet estimated);

/// @param start Starting state; its nutation is fitted anew, but no further nutation is searched.
/// @return The errors of fit().
Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated);

}  // namespace spindrift
