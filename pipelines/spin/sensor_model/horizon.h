/// @file
/// Computes where a pencil beam crosses the Earth's infrared limb, spherical or ellipsoidal.
///
/// The beam from the spacecraft at r along d touches the horizon where
///
///     F = (r.M d)^2 - (d.M d)(r.M r - 1) = 0,    M = 1/a^2 + (1/b^2 - 1/a^2) n n^T
///
/// with the semi-axes a (equator) and b (along the pole n); a sphere has a = b. F = d.Q d is a
/// quadratic form, so that turning the beam by the small vector e changes F by 2 e.(d x Q d): one
/// product gives the derivative by the beam's azimuth and by the tilts of the spin axis.
///
/// Directions are in the frame `spin`: any frame whose third axis is the spin axis.

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

/// Returns the sphere of 6378.137 km, or the WGS-84 ellipsoid, raised by the CO2 altitude.
HorizonAxes horizon_axes(const Horizon& horizon);

enum class Crossing { In, Out };

struct LimbCrossing {
  double azimuth_rad;  ///< Azimuth of the beam, (-pi, pi].
  /// Change per small rotation of the frame about its own axes; the third is -1.
  Eigen::Vector3d azimuth_per_rotation;
  double azimuth_per_limb;                  ///< Change per radian of limb, outwards.
  double azimuth_per_mount;                 ///< Change per mounting angle.
  double azimuth_per_height_km;             ///< Change per km of horizon height.
  Eigen::Vector3d azimuth_per_position_km;  ///< Change per motion of the spacecraft.
};

/// Holds the position of the spacecraft and the Earth's pole in the frame `spin`.
struct EarthView {
  Eigen::Vector3d spacecraft_spin_km;  ///< Position from the Earth's centre.
  Eigen::Vector3d pole_spin;           ///< Unit vector.
};

/// @param mount_angle_rad Angle gamma of the beam from the spin axis.
/// @return Empty when the beam misses the Earth, never leaves it, or is near-tangent to the limb.
std::optional<LimbCrossing> limb_crossing(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, Crossing crossing);

/// Measures the distance of a beam from the limb, in any direction.
struct LimbDistance {
  double depth;                        ///< F/2, positive where the beam is on the Earth.
  Eigen::Vector3d depth_per_rotation;  ///< Change per rotation; the third is by azimuth.
  double depth_bend;                   ///< Second derivative by azimuth.
};

/// @return Empty where the beam points away from the Earth.
std::optional<LimbDistance> limb_distance(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, double azimuth_rad);

}  // namespace spindrift
