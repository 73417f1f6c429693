/// @file
/// Where a pencil beam crosses the Earth's infrared limb, spherical or ellipsoidal.
///
/// The beam from the spacecraft at r along d touches the horizon where
///
///     F = (r.M d)^2 - (d.M d)(r.M r - 1) = 0,    M = 1/a^2 + (1/b^2 - 1/a^2) n n^T
///
/// with the semi-axes a (equator) and b (along the pole n); a sphere has a = b. F = d.Q d is a
/// quadratic form, so that turning the beam by the small vector e changes F by 2 e.(d x Q d): one
/// product gives the derivative by the beam's azimuth and by the tilts of the spin axis.
///
/// Directions in the frame `spin`: any frame whose third axis is the spin axis.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Semi-axes of the infrared horizon.
struct HorizonAxes {
  double equatorial_km;
  double polar_km;
};

/// The sphere of 6378.137 km, or the WGS-84 ellipsoid, raised by the altitude of the CO2.
HorizonAxes horizon_axes(const Horizon& horizon);

enum class Crossing { In, Out };

struct LimbCrossing {
  double azimuth_rad;  ///< Of the beam, (-pi, pi].
  /// Its change when the frame turns by a small vector about its own axes; the third is -1.
  Eigen::Vector3d azimuth_per_rotation;
  double
      azimuth_per_limb;  ///< Likewise, when the limb is a radian farther from the Earth's centre.
  double azimuth_per_mount;      ///< Likewise, by the mounting angle.
  double azimuth_per_height_km;  ///< Likewise, by the height of the horizon above the Earth.
};

/// The Earth as the frame `spin` sees it.
struct EarthView {
  Eigen::Vector3d spacecraft_spin_km;  ///< From the Earth's centre.
  Eigen::Vector3d pole_spin;           ///< Unit.
};

/// @param mount_angle_rad gamma, of the beam from the spin axis.
/// @return Empty when the beam misses the Earth, never leaves it, or is near-tangent to the limb.
std::optional<LimbCrossing> limb_crossing(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, Crossing crossing);

/// How far a beam is from the limb, wherever it points.
struct LimbDistance {
  double depth;                        ///< F/2: positive where the beam is on the Earth.
  Eigen::Vector3d depth_per_rotation;  ///< When the frame turns; the third is also by azimuth.
  double depth_bend;                   ///< Second derivative by azimuth.
};

/// @return Empty where the beam points away from the Earth.
std::optional<LimbDistance> limb_distance(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, double azimuth_rad);

}  // namespace spindrift
