/// @file
/// Two-body orbit about the Earth from classical elements.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Gravitational parameter of the Earth (EGM96, as IERS Conventions 2010 in TT).
inline constexpr double kEarthMu_km3_s2 = 398600.4418;

/// Classical elements at an epoch, referred to EME2000.
struct KeplerElements {
  TaiTime epoch;
  double semi_major_axis_km;
  double eccentricity;     ///< [0, 1)
  double inclination_rad;  ///< [0, pi]
  double raan_rad;
  double argument_of_perigee_rad;
  double mean_anomaly_rad;
};

/// Two-body orbit, defined at any time; without perturbations, so good for hours, not weeks.
class KeplerOrbit {
 public:
  /// @return InvalidConfiguration for an orbit that is not an ellipse, or whose perigee lies
  ///         inside the Earth.
  static Expected<KeplerOrbit> make(const KeplerElements& elements);

  /// Returns the orbit that passes through a state.
  /// @return InvalidInput for a state on no ellipse, or one with its perigee inside the Earth.
  static Expected<KeplerOrbit> through(TaiTime t, const OrbitState& state);

  /// Never fails; the return type is shared by all sources of orbits.
  Expected<OrbitState> at(TaiTime t) const;

  /// Returns the true anomaly at the epoch of the elements, [0, 2 pi).
  double true_anomaly_at_epoch_rad() const;
  /// Returns by how much the true anomaly has grown since the epoch of the elements.
  double true_anomaly_behind_epoch_rad(TaiTime t) const;
  /// Returns when the true anomaly has grown by so much since the epoch of the elements.
  TaiTime when_behind_epoch(double true_anomaly_rad) const;

  TaiTime epoch() const { return epoch_; }
  /// Returns the mean anomaly at the epoch of the elements, [0, 2 pi).
  double mean_anomaly_at_epoch_rad() const;
  double eccentricity() const { return eccentricity_; }
  double mean_motion_rad_s() const { return mean_motion_rad_s_; }

 private:
  KeplerOrbit() = default;
  explicit KeplerOrbit(const KeplerElements& elements);

  TaiTime epoch_;
  double eccentricity_;
  double mean_anomaly_rad_;
  double mean_motion_rad_s_;
  /// Half axes of the ellipse: towards perigee, and along the motion there.
  Eigen::Vector3d semi_major_icrf_km_;
  Eigen::Vector3d semi_minor_icrf_km_;
};

}  // namespace spindrift
