/// @file
/// Unique identifiers.

#pragma once

#include <string>

namespace spindrift {

/// Returns an id unique over all archives that may ever be merged: the time in seconds and fifty
/// random bits, at five bits per character. It is short, since every row of a run carries one.
std::string unique_id();

}  // namespace spindrift
