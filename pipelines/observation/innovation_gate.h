/// @file
/// From where on an innovation contradicts.

#pragma once

namespace spindrift {

/// Of the normalised innovation squared: so much noise alone reaches once in 1.7 million.
/// @param freedom 1 to 3.
double innovation_gate(int freedom);

}  // namespace spindrift
