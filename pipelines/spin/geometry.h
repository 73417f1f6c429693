/// @file
/// The spherical geometry of spin axis, Sun and Earth (spin.md, "Earth angle" and "Attitude").
/// Angles in radians, directions are unit vectors in ICRF.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

/// rho = asin((R_earth + h) / r), the spherical Earth with R_earth = 6378.137 km.
/// @return Unobservable when the spacecraft is not above that sphere, or beyond a million km.
Expected<double> earth_disc_half_angle_rad(double range_km, double co2_altitude_km);

/// A chord across the Earth's disc, and the mounting angle of the beam that drew it.
struct Chord {
  double mount_angle_rad;  ///< gamma
  double chord_rad;        ///< Phi
};

/// How far an oblate Earth's limb lies from that of the sphere, at most: the seat of what the
/// spherical horizon leaves out. @param disc_rad rho.
double oblateness_rad(double disc_rad);

/// theta_e from both chords, which needs no rho.
/// @return Unobservable when the two equations are nearly the same (mounting angles alike).
Expected<double> earth_angle_from_two_chords(const Chord& north, const Chord& south);

/// rho as one chord shows it from a known theta_e: the check that two chords leave over.
double disc_seen_rad(const Chord& chord, double earth_angle_rad);

/// The right-hand sides of the one-chord equations.
struct OneChordInput {
  Chord chord;
  double sun_angle_rad;
  double dihedral_rad;
  double sun_earth_rad;  ///< theta_se
  double disc_rad;       ///< rho
};

/// Delta = cos g sin(theta_s) cos(lambda) - cos(theta_s) sin g cos(Phi/2): the smaller, the less
/// the two linear equations for theta_e differ.
double determinant(const OneChordInput& input);

/// theta_e of the linear solution; good where |Delta| is large.
double earth_angle_linear(const OneChordInput& input);

/// Both roots of the chord equation that lie in (0, pi), the one that fits theta_se better first.
/// @return Unobservable when the chord is wider than the disc allows.
Expected<std::vector<double>> earth_angle_roots(const OneChordInput& input);

/// The axis that has the given angles to Sun and Earth, and the dihedral between them.
struct AxisInput {
  Eigen::Vector3d sun_icrf;
  Eigen::Vector3d earth_icrf;
  double sun_angle_rad;
  double earth_angle_rad;
  double dihedral_rad;
};

/// P from P.S, P.E and P.(S x E), not normalised: its length is 1 when the three agree.
/// Sun and Earth must not be in line (the caller tests it).
Eigen::Vector3d axis_icrf(const AxisInput& input);

/// What a revolution should measure if the axis were `axis_icrf`.
struct PredictedAngles {
  double sun_angle_rad;
  double earth_angle_rad;
  double dihedral_rad;
};
PredictedAngles predict_angles(const Eigen::Vector3d& axis_icrf, const Eigen::Vector3d& sun_icrf,
                               const Eigen::Vector3d& earth_icrf);

/// Phi = 2 acos((cos rho - cos g cos theta_e) / (sin g sin theta_e)); empty when the beam misses
/// the disc or never leaves it.
std::optional<double> predict_chord_rad(double mount_angle_rad, double earth_angle_rad,
                                        double disc_rad);

}  // namespace spindrift
