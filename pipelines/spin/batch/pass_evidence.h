/// @file
/// What the solution of a pass says of the errors of the mission file, for the pass itself and for
/// a calibration over many passes.

#pragma once

#include "pipelines/observation/normal_equations.h"
#include "pipelines/spin/batch/evaluated_fit.h"
#include "pipelines/spin/types/spin_alignment_evidence.h"

namespace spindrift {

/// Returns the evidence about the mission file's values, with motion, the offsets of the channels,
/// and the estimated biases that no key of the file holds, eliminated.
SpinAlignmentEvidence alignment_evidence(const PassModel& model, const EvaluatedFit& found);

/// Returns the same for a calibration, in the units of the keys, of the sensors that exist.
NormalEquations normal_equations(const PassModel& model, const EvaluatedFit& found);

}  // namespace spindrift
