/// @file
/// The spherical geometry of spin axis, Sun and Earth (Wang 2015). Angles are in radians,
/// directions are unit vectors in ICRF.
///
/// Functions used by fixes are templates on the scalar, so that they also yield derivatives.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/frames/angle.h"

namespace spindrift {

/// Standard deviation beyond which an axis is undetermined, as slopes mean nothing so far away.
inline constexpr double kLeastDetermined_rad = 0.5;

/// Returns rho = asin((R_earth + h) / r) for the spherical Earth with R_earth = 6378.137 km.
/// @return Unobservable when the spacecraft is not above that sphere, or beyond a million km.
Expected<double> earth_disc_half_angle_rad(double range_km, double co2_altitude_km);

/// Holds a chord across the Earth's disc and the mounting angle of its beam.
template <class T>
struct ChordOf {
  double mount_angle_rad;  ///< Mounting angle gamma.
  T chord_rad;             ///< Chord Phi.
};
using Chord = ChordOf<double>;

/// Returns whether the cosines of the mounting angles differ by less than 0.01 (0.6 deg near the
/// equator), so that both beams measure the same chord.
bool mount_angles_coincide(double one_rad, double other_rad);

/// Solves theta_e in (0, pi) from both chords, without rho. The mounting angles must differ; the
/// caller tests this.
template <class T>
T earth_angle_from_two_chords(const ChordOf<T>& north, const ChordOf<T>& south) {
  using std::atan2, std::cos;
  const double sine = std::cos(north.mount_angle_rad) - std::cos(south.mount_angle_rad);
  const T cosine = std::sin(south.mount_angle_rad) * T{cos(0.5 * south.chord_rad)} -
                   std::sin(north.mount_angle_rad) * T{cos(0.5 * north.chord_rad)};
  // The sine of theta_e is positive whichever beam stands nearer the axis.
  return atan2(T{std::abs(sine)}, T{std::copysign(1.0, sine) * cosine});
}

/// Returns cos(rho) from one chord and a known theta_e, as a check of a two-chord solution.
template <class T>
T cos_disc_seen(const ChordOf<T>& chord, const T& earth_angle_rad) {
  using std::cos, std::sin;
  return std::cos(chord.mount_angle_rad) * T{cos(earth_angle_rad)} +
         std::sin(chord.mount_angle_rad) * T{sin(earth_angle_rad)} * T{cos(0.5 * chord.chord_rad)};
}

/// Holds the input of the one-chord equations.
template <class T>
struct OneChordInput {
  ChordOf<T> chord;
  T sun_angle_rad;
  T dihedral_rad;
  double sun_earth_rad;  ///< Angle theta_se between Sun and Earth.
  T disc_rad;            ///< Half-angle rho of the Earth's disc.
};

/// Returns Delta = cos g sin(theta_s) cos(lambda) - cos(theta_s) sin g cos(Phi/2): the smaller it
/// is, the less the two linear equations for theta_e differ.
template <class T>
T determinant(const OneChordInput<T>& input) {
  using std::cos, std::sin;
  const T chord_sine = std::sin(input.chord.mount_angle_rad) * T{cos(0.5 * input.chord.chord_rad)};
  return std::cos(input.chord.mount_angle_rad) * T{sin(input.sun_angle_rad)} *
             T{cos(input.dihedral_rad)} -
         T{cos(input.sun_angle_rad)} * chord_sine;
}

/// Returns theta_e of the linear solution, which is accurate where |Delta| is large.
template <class T>
T earth_angle_linear(const OneChordInput<T>& input) {
  using std::atan2, std::cos, std::sin;
  const double cos_mount = std::cos(input.chord.mount_angle_rad);
  const T chord_sine = std::sin(input.chord.mount_angle_rad) * T{cos(0.5 * input.chord.chord_rad)};
  const T cos_sun = cos(input.sun_angle_rad);
  const T sun_sine = T{sin(input.sun_angle_rad)} * T{cos(input.dihedral_rad)};
  const T cos_disc = cos(input.disc_rad);
  const double cos_sun_earth = std::cos(input.sun_earth_rad);
  const T cosine = cos_disc * sun_sine - cos_sun_earth * chord_sine;
  const T sine = cos_mount * cos_sun_earth - cos_sun * cos_disc;
  const double sign = cos_mount * sun_sine > cos_sun * chord_sine ? 1.0 : -1.0;
  return atan2(T{sign * sine}, T{sign * cosine});
}

/// Holds the angles x with a cos x + b sin x = c.
template <class T>
struct ConeRootsOf {
  std::vector<T> angles_rad;   ///< Roots in (0, pi).
  std::vector<T> outside_rad;  ///< Roots in (-pi, 0] or [pi, 2 pi), valid only through noise.
  T excess;                    ///< |c| / hypot(a, b) - 1; from zero on there is no root.
};

/// Returns where two cones meet: a chord and the Earth's disc (x = theta_e), or a dihedral and the
/// angle between Sun and Earth (x = theta_s).
template <class T>
ConeRootsOf<T> cone_roots(const T& a, const T& b, const T& c) {
  using std::acos, std::atan2, std::sqrt;
  const T cosine = c / T{sqrt(T{a * a + b * b})};
  ConeRootsOf<T> roots{.angles_rad = {},
                       .outside_rad = {},
                       .excess = cosine < 0.0 ? T{-cosine - 1.0} : T{cosine - 1.0}};
  if (!(roots.excess < 0.0)) {
    return roots;
  }
  const T centre_rad = atan2(b, a);
  const T apart_rad = acos(cosine);
  for (T root : {T{centre_rad - apart_rad}, T{centre_rad + apart_rad}}) {
    if (root <= -std::numbers::pi) {
      root += kTurn_rad;
    }
    const bool inside = root > 0.0 && root < std::numbers::pi;
    (inside ? roots.angles_rad : roots.outside_rad).push_back(root);
  }
  return roots;
}

/// Holds the angles of an axis to Sun and Earth, and the dihedral between them.
template <class T>
struct AxisInput {
  Eigen::Vector3d sun_icrf;
  Eigen::Vector3d earth_icrf;
  T sun_angle_rad;
  T earth_angle_rad;
  T dihedral_rad;
};

/// Returns P from P.S, P.E and P.(S x E), not normalised: its length is 1 when the three agree. Sun
/// and Earth must not be in line; the caller tests this.
template <class T>
Eigen::Matrix<T, 3, 1> axis_icrf(const AxisInput<T>& input) {
  using std::cos, std::sin;
  const Eigen::Vector3d normal = input.sun_icrf.cross(input.earth_icrf);
  const double cos_sun_earth = input.sun_icrf.dot(input.earth_icrf);
  const T cos_sun = cos(input.sun_angle_rad);
  const T cos_earth = cos(input.earth_angle_rad);
  const T along_sun = cos_sun - cos_sun_earth * cos_earth;
  const T along_earth = cos_earth - cos_sun_earth * cos_sun;
  const T triple =
      T{sin(input.sun_angle_rad)} * T{sin(input.earth_angle_rad)} * T{sin(input.dihedral_rad)};
  Eigen::Matrix<T, 3, 1> axis;
  for (Eigen::Index i = 0; i < 3; ++i) {
    axis[i] =
        (along_sun * input.sun_icrf[i] + along_earth * input.earth_icrf[i] + triple * normal[i]) /
        normal.squaredNorm();
  }
  return axis;
}

/// Returns whether Sun and Earth are within 3 deg of one line, about which the axis is then free.
/// @param sun_earth_rad Angle theta_se between Sun and Earth.
bool in_line(double sun_earth_rad);

/// Holds the angles that a revolution should measure with a given axis.
struct PredictedAngles {
  double sun_angle_rad;
  double earth_angle_rad;
  double dihedral_rad;
};
PredictedAngles predict_angles(const Eigen::Vector3d& axis_icrf, const Eigen::Vector3d& sun_icrf,
                               const Eigen::Vector3d& earth_icrf);

/// Returns Phi = 2 acos((cos rho - cos g cos theta_e) / (sin g sin theta_e)); empty when the beam
/// misses the disc or never leaves it.
std::optional<double> predict_chord_rad(double mount_angle_rad, double earth_angle_rad,
                                        double disc_rad);

}  // namespace spindrift
