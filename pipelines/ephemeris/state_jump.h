/// @file
/// Whether the states of an orbit follow from each other.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// How far (km) `to` lies from where `from` falls to, when that is more than any real orbit
/// explains: 10 km, a twentieth of the way, and what a change of velocity that shows in `to` could
/// have made of it. Steps of more than six hours, back in time, and states inside the Earth (no
/// orbit of it, as the printed examples of the format) are not judged.
std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to);

/// The same distance, when it is more than a sound orbit explains, be it two-body or real: states
/// that are printed to 1 km and 1 m/s, J2, Moon and Sun, as far as gravity's gradient can carry
/// what they do, and a change of velocity that shows in `to`. About 2 km over 2 minutes near the
/// Earth and over 10 minutes in the geostationary ring, 100 km over half an hour near the Earth. Of
/// a manoeuvre that is a quarter of a revolution back, too little shows in `to`.
std::optional<double> unexplained_km(const EphemerisPoint& from, const EphemerisPoint& to);

/// The difference between two states that are of one instant, or are carried to it.
struct Departure {
  double km;
  double km_s;
};

/// Of `to` from where `from` falls to, when position or velocity is farther off than
/// `unexplained_km` allows a sound orbit without a manoeuvre. Not judged are the steps that
/// `jump_km` does not.
std::optional<Departure> departure(const EphemerisPoint& from, const EphemerisPoint& to);

/// Where an orbit is halfway in time from one state to the next: two-body motion, and evenly
/// changing what carries it from there to `to`, good to metres over half an hour. Empty for states
/// inside the Earth.
std::optional<Eigen::Vector3d> halfway_icrf_km(const EphemerisPoint& from,
                                               const EphemerisPoint& to);

/// A step that nothing explains.
struct OrbitJump {
  EphemerisPoint to;
  double off_km;    ///< The position is so far from where the point before it leads to.
  double off_km_s;  ///< The velocity is so far from what the point before it leads to.
  TaiTime from;     ///< The point before it has this time.
};

/// In order of time, those between the points of a segment and, from the last point that is usable
/// to the first, between segments.
std::vector<OrbitJump> orbit_jumps(const OrbitEphemeris& ephemeris);

}  // namespace spindrift
