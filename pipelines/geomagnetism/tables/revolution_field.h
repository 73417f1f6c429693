/// @file
/// The field along one revolution of an orbit, in the orbit frame, against true anomaly: what an
/// on-board table has to give (Liu 2019, par. 1).

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/geomagnetism/main_field.h"

namespace spindrift {

/// @return Field in the orbit frame (flight_frames.h), nT; InvalidInput within the core.
Expected<Eigen::Vector3d> field_orbit_nt(const MainField& field, const OrbitState& spacecraft,
                                         const Eigen::Quaterniond& q_icrf_itrf);

/// One revolution of an orbit from the epoch of its elements on, the Earth turning below it.
class RevolutionField {
 public:
  RevolutionField(const KeplerOrbit& orbit, const MainField& field)
      : orbit_{orbit}, field_{field} {}

  /// @param behind_first_rad True anomaly behind that at the epoch.
  /// @return Field in the orbit frame, nT.
  Expected<Eigen::Vector3d> at(double behind_first_rad);

  /// @return How far the field at the same anomaly is off a revolution later, when the Earth has
  ///         turned: mean length of the difference, nT.
  Expected<double> off_a_revolution_later_nt();

 private:
  KeplerOrbit orbit_;
  MainField field_;
  TurningEarth earth_;
};

}  // namespace spindrift
