/// @file
/// Checks whether the states of an orbit follow from each other.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// Returns the distance (km) of `to` from `from` propagated by two-body motion, when it is more
/// than any real orbit explains: 10 km, a twentieth of the way, and what a change of velocity that
/// shows in `to` could have caused. Steps of more than six hours or back in time, and states inside
/// the Earth (as in the printed examples of the format), are not judged.
std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to);

/// Returns the same distance, when it is more than a sound orbit explains, be it two-body or real:
/// states printed to 1 km and 1 m/s, J2, Moon and Sun with the growth of their effect by gravity's
/// gradient, and a change of velocity that shows in `to`. The limit is about 2 km over 2 minutes
/// near the Earth and over 10 minutes in the geostationary ring, 100 km over half an hour near the
/// Earth. A manoeuvre a quarter of a revolution earlier shows too little in `to`.
std::optional<double> unexplained_km(const EphemerisPoint& from, const EphemerisPoint& to);

/// Difference between two states of one instant.
struct Departure {
  double km;
  double km_s;
};

/// Returns the difference of `to` from `from` propagated by two-body motion, when position or
/// velocity differs by more than `unexplained_km` allows a sound orbit without a manoeuvre. Steps
/// that `jump_km` does not judge are not judged here either.
std::optional<Departure> departure(const EphemerisPoint& from, const EphemerisPoint& to);

/// Returns the position halfway in time between two states: two-body motion, smoothly corrected to
/// meet `to`, good to metres over half an hour. Empty for states inside the Earth.
std::optional<Eigen::Vector3d> halfway_icrf_km(const EphemerisPoint& from,
                                               const EphemerisPoint& to);

/// A jump that `unexplained_km` finds.
struct OrbitJump {
  EphemerisPoint to;
  double off_km;    ///< Distance of `to` from the propagated point before it.
  double off_km_s;  ///< Difference of its velocity from that of the propagated point.
  TaiTime from;     ///< Time of the point before it.
};

/// Returns the jumps in order of time, between the points of a segment and between segments, from
/// the last usable point to the first.
std::vector<OrbitJump> orbit_jumps(const OrbitEphemeris& ephemeris);

}  // namespace spindrift
