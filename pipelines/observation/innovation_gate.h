/// @file
/// The gate beyond which an innovation contradicts what the estimator expects.

#pragma once

namespace spindrift {

/// Returns the normalised innovation squared that noise exceeds once in 1.7 million samples.
/// @param freedom Degrees of freedom, 1 to 3.
double innovation_gate(int freedom);

}  // namespace spindrift
