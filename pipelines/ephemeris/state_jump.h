/// @file
/// Whether two states of one spacecraft follow from each other.

#pragma once

#include <optional>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// How far (km) `to` lies from where `from` falls to, when that is more than any real orbit
/// explains: 10 km, the whole way between the two, and what a change of velocity that shows in `to` could
/// have made of it. Steps of more than six hours, and back in time, are not judged.
std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to);

}  // namespace spindrift
