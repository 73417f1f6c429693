/// @file
/// Geometry of one instant of a coming pass: what each sensor sees, and which fix a turn gives.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/measurement/sun_earth_ephemeris.h"
#include "pipelines/spin/planning/expected_revolution.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class BeamSight {
  NoSensor,
  Misses,       ///< The Earth.
  NearTangent,  ///< Near-tangent to the limb: the edges say nothing of the axis.
  Crosses,      ///< It: two edges a turn.
  Inside,       ///< Its disc all the turn: no edge.
};

/// How far one chord, without the other, determines the axis.
enum class DeltaClass { Usable, TwoRoots, Ambiguous };

struct BeamGeometry {
  BeamSight view;
  /// Phi, there when it crosses.
  std::optional<double> chord_rad;
  /// Determinant of the fix by this chord alone, there when the sun slits see the Sun besides.
  std::optional<double> delta;
};

/// The fix that one turn gives.
struct FixGeometry {
  int geometry_case;  ///< Of pipelines/spin/fix/README.md; 0: nothing of an axis.
  std::size_t axes;   ///< How many candidates one turn leaves; 0: there is no fix.
  bool told_apart;    ///< The geometry alone shows which.
  /// One standard deviation from the noise of the edges, both axes together. Empty: no fix.
  std::optional<double> sigma_rad;
};

struct PassGeometry {
  TaiTime t;
  double range_km;
  PredictedAngles angles;
  double sun_earth_rad;
  double disc_rad;  ///< rho, of the spherical Earth.
  bool sun_hidden;  ///< By the Earth.
  bool in_line;     ///< Sun and Earth: they leave the axis free to turn about them.
  std::array<BeamGeometry, 2> beams;  ///< By Side.
  ExpectedRevolution expected;        ///< With the horizon that the mission asks for.
  FixGeometry fix;                    ///< On the sphere, as all fixes are.
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
  Eigen::Matrix3d R_spin_icrf_;  ///< East, north, axis.
  double rate_rad_s_;
};

}  // namespace spindrift
