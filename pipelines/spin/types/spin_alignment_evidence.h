/// @file
/// This file holds what the measurements of a pass say of the errors of the mission file.

#pragma once

#include <optional>

#include "pipelines/spin/types/alignment.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

/// Holds the normal equations of the errors, with all other unknowns eliminated.
struct SpinAlignmentEvidence {
  SpinAlignment information = SpinAlignment::Zero();
  SpinAlignmentVector score = SpinAlignmentVector::Zero();
};

/// Returns the evidence about the errors, with the offsets of the channels eliminated.
/// @param information, score Of all considered parameters, with all other unknowns eliminated.
SpinAlignmentEvidence beside_offsets(const ConsideredPrior& information,
                                     const ConsideredVector& score, const ConsideredPrior& prior);

/// Holds how far an error goes beyond what the mission file states, in its unit.
struct AlignmentExcess {
  SpinAlignmentError error;
  double value;
  double gain;  ///< Chi-square of one degree of freedom that it explains.
};

/// Returns the single error that explains most of what errors within their prior leave over; empty
/// where the measurements depend on none.
std::optional<AlignmentExcess> worst_excess(const SpinAlignmentEvidence& evidence,
                                            const SpinAlignment& prior);

}  // namespace spindrift
