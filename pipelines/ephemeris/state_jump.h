/// @file
/// Whether two states of one spacecraft follow from each other.

#pragma once

#include <optional>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// How far (km) `to` lies from where `from` falls to, when that is more than any real orbit
/// explains: 10 km, a twentieth of the way, and what a change of velocity that shows in `to` could
/// have made of it. Steps of more than six hours, back in time, and states inside the Earth (no
/// orbit of it, as the printed examples of the format) are not judged.
std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to);

}  // namespace spindrift
