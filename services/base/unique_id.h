/// @file
/// Names for what is made now.

#pragma once

#include <string>

namespace spindrift {

/// Unique over all archives that may ever be merged: the second and fifty random bits, five a
/// character. Short, since every row of a run bears one.
std::string unique_id();

}  // namespace spindrift
