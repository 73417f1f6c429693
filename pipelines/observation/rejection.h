/// @file
/// The reasons for rejecting a measurement, by tests ahead of an estimator or by the estimator.

#pragma once

#include <string_view>

namespace spindrift {

/// schemas/tables.sql describes each reason in words (table `rejection`). From Period on they are
/// the rationality tests of the angles and the period of a revolution.
enum class Rejection {
  Unassociated,  ///< No revolution had a place for the edge.
  Late,          ///< It arrived after its time had been processed.
  OutOfTime,     ///< The time is far from all others, by a clock that no other supports.
  Contradicted,  ///< Its senders contradict each other and none is preferred.
  Copy,          ///< It is a copy of an edge; another copy counts, or this one came alone.
  Interference,  ///< An edge of another channel is so near that both are corrupted.
  Operator,      ///< An operator has excluded it.
  Phase,         ///< It is off the phase of its channel's edges, or is derived from such an edge.
  Geometry,      ///< The measurement is meaningless (chord of a whole turn, slit lag out of range).
  NoSensor,      ///< The mission file has no such sensor.
  NoOrbit,     ///< The orbit does not cover it, or an orbit state is on no ellipse round the Earth.
  NoField,     ///< The field model does not cover it.
  Saturated,   ///< The gyro turned faster than its range.
  Frozen,      ///< The sensor repeats its values beyond chance.
  Outlier,     ///< The gyro sample departs from its neighbours.
  Shadow,      ///< The Sun is eclipsed by the Earth.
  Unit,        ///< Star fixes show that the gyro's rates are in another unit.
  Innovation,  ///< It is too far from the estimator's prediction, or there is no prediction.
  Period,      ///< It failed the spin-period test.
  SunAngle,    ///< It failed the 3-sigma test of this quantity, as do all below.
  NorthChord,
  SouthChord,
  NorthDihedral,
  SouthDihedral,
  MixedAzimuth,
};
inline constexpr int kRejections = static_cast<int>(Rejection::MixedAzimuth) + 1;
std::string_view name_of(Rejection rejection);

}  // namespace spindrift
