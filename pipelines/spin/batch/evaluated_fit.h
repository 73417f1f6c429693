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
  PassInformation information;  ///< Less what the unknowns of its nutation take of it.
  OffsetPrior offsets_s2;       ///< Of the channels' times, which it takes for zero.
  std::optional<NutationSearch> nutation;

  /// What the edges say whatever the offsets of their channels are: of the state that fits best
  /// then, as far as one step leads there.
  PassInformation beside_offsets() const;
  double excess_noise() const;
  double misfit() const;
};

/// @param start Its nutation is fitted anew, where it has any, and none is looked for.
/// @return As fit().
Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated);

}  // namespace spindrift
