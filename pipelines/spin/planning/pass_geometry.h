/// @file
/// Geometry of one instant of a coming pass: what each sensor sees, and which fix a turn gives.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/measurement/sun_earth_ephemeris.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Channels whose edges come so near to each other that they spoil each other.
struct ColocatedChannels {
  PulseChannel one;
  PulseChannel other;
};

/// One turn of the body as its sensors should see it, for a known axis and spin rate.
struct ExpectedRevolution {
  /// Edges without noise, to the nearest nanosecond; those that meet are rejected as
  /// `Interference`.
  Revolution revolution;
  /// Prediction of each edge that exists.
  std::array<std::optional<PredictedEdge>, kPulseChannels> predicted;
  std::vector<ColocatedChannels> meeting;
};

/// Returns the turn that begins with slit 1 at the Sun at the time of the sky; chords begin in it.
/// @param R_spin_icrf Rotation to a frame `spin` (edge_prediction.h).
/// @param sun_hidden Whether the Earth hides the Sun, so that there are no sun edges.
ExpectedRevolution expected_revolution(const SpinConfig& config, const Sky& sky,
                                       const Eigen::Matrix3d& R_spin_icrf, double rate_rad_s,
                                       bool sun_hidden);

enum class BeamSight {
  NoSensor,
  Misses,       ///< The beam misses the Earth.
  NearTangent,  ///< Near-tangent to the limb: the edges say nothing of the axis.
  Crosses,      ///< The beam crosses the Earth: two edges a turn.
  Inside,       ///< The beam stays within the disc all the turn: no edge.
};

/// How far one chord, without the other, determines the axis.
enum class DeltaClass { Usable, TwoRoots, Ambiguous };

struct BeamGeometry {
  BeamSight view;
  /// Phi, the chord; empty unless the beam crosses the Earth.
  std::optional<double> chord_rad;
  /// Determinant of the fix by this chord alone; empty unless both slits see the Sun too.
  std::optional<double> delta;
};

/// The fix that one turn gives.
struct FixGeometry {
  int geometry_case;  ///< Case in pipelines/spin/fix/README.md; 0: nothing of an axis.
  std::size_t axes;   ///< How many candidates one turn leaves; 0: there is no fix.
  bool told_apart;    ///< Whether the geometry alone shows which is true.
  /// One standard deviation by noise and alignment, both directions together. Empty: no fix.
  std::optional<double> sigma_rad;
};

struct PassGeometry {
  TaiTime t;
  double range_km;
  PredictedAngles angles;
  double sun_earth_rad;
  double disc_rad;  ///< rho, disc half-angle of the spherical Earth.
  bool sun_hidden;  ///< Whether the Earth hides the Sun.
  bool in_line;     ///< Sun and Earth in line: the axis is free to turn about them.
  std::array<BeamGeometry, 2> beams;  ///< Indexed by Side.
  ExpectedRevolution expected;        ///< Turn with the horizon of the mission file.
  FixGeometry fix;                    ///< Fix on the sphere, as all fixes are.
};

DeltaClass class_of(const SpinGeometry& limits, double delta);

/// A body that turns evenly about an axis at rest, along its orbit.
class PassScene {
 public:
  /// @param axis_icrf Unit.
  PassScene(SpinConfig config, Orbit orbit, const Eigen::Vector3d& axis_icrf, double rate_rad_s);

  /// @return NoCoverage where the orbit does not reach; Unobservable below the horizon's height.
  Expected<PassGeometry> at(TaiTime t);

  const SpinConfig& config() const { return config_; }
  double rate_rad_s() const { return rate_rad_s_; }

 private:
  BeamGeometry beam(Side side, const PassGeometry& geometry) const;
  Revolution turn_on_sphere(const Sky& sky, const PassGeometry& geometry) const;
  FixGeometry fix(const Sky& sky, const PassGeometry& geometry) const;

  SpinConfig config_;
  SpinConfig on_sphere_;
  SunEarthEphemeris around_;
  Eigen::Vector3d axis_icrf_;
  Eigen::Matrix3d R_spin_icrf_;  ///< Rows are east, north and axis.
  double rate_rad_s_;
};

}  // namespace spindrift
