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
  OffsetPrior offsets_s2;       ///< Prior of channel time offsets; `information` assumes zero.
  std::optional<NutationSearch> nutation;

  /// Returns the equations with unknown time offsets of the channels, one step nearer to the best
  /// state.
  PassInformation beside_offsets() const;
  double excess_noise() const;
  double misfit() const;
};

/// @param start Starting state; its nutation is fitted anew, but no further nutation is searched.
/// @return The errors of fit().
Expected<EvaluatedFit> explain(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& start, BiasSet estimated);

}  // namespace spindrift
