/// @file
/// Why a measurement was left out: by the tests before an estimator, or by the estimator itself.

#pragma once

#include <string_view>

namespace spindrift {

/// schemas/tables.sql says each in words (table `rejection`). From Period on they are the tests of
/// the angles and the period of a revolution.
enum class Rejection {
  Unassociated,  ///< No revolution had a place for the edge.
  Late,          ///< It arrived after its time had been processed.
  OutOfTime,     ///< It is far from all others in time, by a clock that nothing else agrees with.
  Contradicted,  ///< It came with other values, too, and no sender is preferred.
  Copy,          ///< The channel's edges come several times: another counts, or it came alone.
  Interference,  ///< An edge of another channel is so near that both are spoilt.
  Operator,      ///< An operator has left it out.
  Phase,     ///< It is not where the edges of its channel lie; a measurement rests on such an edge.
  Geometry,  ///< The measurement has no meaning (chord of a whole turn, slit lag out of range).
  NoSensor,  ///< The mission file has no such sensor.
  NoOrbit,   ///< The orbit does not cover it; an orbit state is on no ellipse round the Earth.
  NoField,   ///< The model of the field does not reach it.
  Saturated,   ///< The gyro turned faster than its range.
  Frozen,      ///< The sensor gives the same numbers as too many times before.
  Outlier,     ///< The gyro's samples beside it are elsewhere.
  Shadow,      ///< The Earth is before the Sun.
  Unit,        ///< The gyro's rates are in another unit, by the star fixes.
  Innovation,  ///< It is too far from where the estimator expects it, or nothing is expected there.
  Period,      ///< It failed the spin-period test.
  SunAngle,    ///< It failed the 3-sigma test of that quantity; likewise the following.
  NorthChord,
  SouthChord,
  NorthDihedral,
  SouthDihedral,
  MixedAzimuth,
};
inline constexpr int kRejections = static_cast<int>(Rejection::MixedAzimuth) + 1;
std::string_view name_of(Rejection rejection);

}  // namespace spindrift
