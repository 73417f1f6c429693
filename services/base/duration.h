/// @file
/// Formats durations for people.

#pragma once

#include <string>

namespace spindrift {

/// Returns "3 days 11 h", "5 h 20 min", "12 min 5 s", "8 s" or "0.4 s": at most two units, rounded
/// to the smaller.
/// @param seconds Not negative, finite.
std::string duration_text(double seconds);

}  // namespace spindrift
