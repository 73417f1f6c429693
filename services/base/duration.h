/// @file
/// How long, as people say it.

#pragma once

#include <string>

namespace spindrift {

/// "3 days 11 h", "5 h 20 min", "12 min 5 s", "8 s", "0.4 s": two units at most, rounded to the
/// smaller.
/// @param seconds Not negative, finite.
std::string duration_text(double seconds);

}  // namespace spindrift
