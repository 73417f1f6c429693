/// @file
/// How the body turns: an axis at rest, a rate that drifts evenly; about it nutation and coning.
///
/// The frame `axes` stands still: east and north of the axis (`tangent_basis`), and the axis, which
/// is that of the angular momentum. An axisymmetric body left alone turns in it by (3-1-3)
///
///     R_axes_body = Rz(psi) Rx(theta) Rz(phi)
///     psi' = H / I_t = w_z (I_s/I_t) / cos theta,    phi' = w_z (1 - I_s/I_t)
///
/// with theta the half-angle, I_s and I_t the moments of inertia about the axis of symmetry and
/// across it, w_z the spin about the former, H cos theta = I_s w_z the angular momentum. The axis
/// of symmetry goes round the angular momentum, with the spin, psi'/(psi' + phi') times as fast as
/// the body turns: to first order I_s/I_t, slower than the spin for a slender body. psi + phi is
/// the azimuth of slit 1 that an even spin would have, so that (while theta grows slowly, too)
///
///     R_axes_body = R(theta about (cos psi, sin psi, 0)) Rz(azimuth)
///
/// Coning: the sensors' frame is tipped in the body by an angle that stays.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace spindrift {

/// Free nutation of an axisymmetric body; where the rate drifts, at the same share of it.
struct Nutation {
  double half_angle_rad = 0.0;     ///< Between angular momentum and axis of symmetry, [0, pi/2),
                                   ///< at the start.
  double inertia_ratio = 1.0;      ///< I_s/I_t, (0, 2].
  double first_azimuth_rad = 0.0;  ///< To which the axis leans at the start, in `axes`.
  double growth_per_s = 0.0;       ///< Of the half-angle, as a share of it: dissipation drives it.

  double half_angle_at_rad(double t_s) const {
    return half_angle_rad * std::exp(growth_per_s * t_s);
  }

  /// Turns of the axis round the angular momentum in a turn of the body.
  double per_turn() const {
    return inertia_ratio / (inertia_ratio + (1.0 - inertia_ratio) * std::cos(half_angle_rad));
  }
};

struct Coning {
  double tilt_rad = 0.0;     ///< Between the axis of symmetry and that of the sensors, [0, pi/2).
  double azimuth_rad = 0.0;  ///< Behind slit 1, to which the sensors' axis leans in the body.
};

/// Turns right-handed about the axis. The azimuth of slit 1 is counted about the axis from the
/// direction east of it (`tangent_basis`).
struct SpinMotion {
  Eigen::Vector3d axis_icrf;  ///< Unit length.
  double rate_rad_s;          ///< At the start, the mean about the axis; positive all the time.
  double rate_drift_rad_s2;
  double first_azimuth_rad;  ///< Of slit 1 at the start.
  Nutation nutation = {};
  Coning coning = {};

  /// Azimuth of slit 1 in an even spin, not wrapped.
  double azimuth_rad(double t_s) const {
    return first_azimuth_rad + (rate_rad_s + 0.5 * rate_drift_rad_s2 * t_s) * t_s;
  }
  double rate_at_rad_s(double t_s) const { return rate_rad_s + rate_drift_rad_s2 * t_s; }
  /// It turns for ever.
  static constexpr double end_s() { return std::numeric_limits<double>::infinity(); }

  /// How the sensors are tipped: they stand as in an even spin about the third axis of `tipped`,
  /// R_axes_sensors = R_axes_tipped Rz(azimuth). Exactly the identity where nothing wobbles.
  Eigen::Matrix3d R_axes_tipped(double t_s) const {
    const double turned_rad = azimuth_rad(t_s) - first_azimuth_rad;
    return as_coned(nutation.half_angle_at_rad(t_s),
                    nutation.first_azimuth_rad + nutation.per_turn() * turned_rad) *
           as_coned(coning.tilt_rad, azimuth_rad(t_s) - coning.azimuth_rad);
  }

 private:
  /// Tips the third axis towards this azimuth.
  static Eigen::Matrix3d as_coned(double angle_rad, double towards_rad) {
    const Eigen::Vector3d hinge{-std::sin(towards_rad), std::cos(towards_rad), 0.0};
    return Eigen::AngleAxisd{angle_rad, hinge}.toRotationMatrix();
  }
};

}  // namespace spindrift
