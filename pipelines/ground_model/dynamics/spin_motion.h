/// @file
/// Closed-form spin: a fixed axis, a linearly drifting rate, and nutation and coning about the
/// axis.
///
/// The frame `axes` is inertially fixed: its first two axes point east and north of the spin axis
/// (`tangent_basis`), its third is the spin axis, that of the angular momentum. A torque-free
/// axisymmetric body turns in it by (3-1-3)
///
///     R_axes_body = Rz(psi) Rx(theta) Rz(phi)
///     psi' = H / I_t = w_z (I_s/I_t) / cos theta,    phi' = w_z (1 - I_s/I_t)
///
/// with theta the half-angle, I_s and I_t the moments of inertia about the axis of symmetry and
/// across it, w_z the spin about the former, H cos theta = I_s w_z the angular momentum. The axis
/// of symmetry goes round the angular momentum in the sense of the spin, psi'/(psi' + phi') times
/// as fast as the body turns: to first order I_s/I_t, slower than the spin for a slender body. psi
/// + phi is the azimuth that slit 1 would have in a uniform spin, so that (theta may grow slowly)
///
///     R_axes_body = R(theta about (cos psi, sin psi, 0)) Rz(azimuth)
///
/// Coning: the sensors' frame is tipped in the body by a constant angle.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace spindrift {

/// Free nutation of an axisymmetric body. Where the spin rate drifts, the nutation rate stays the
/// same fraction of it.
struct Nutation {
  /// Angle between angular momentum and axis of symmetry at the start, [0, pi/2).
  double half_angle_rad = 0.0;
  double inertia_ratio = 1.0;      ///< I_s/I_t, (0, 2].
  double first_azimuth_rad = 0.0;  ///< Azimuth in `axes` towards which the axis leans at the start.
  double growth_per_s = 0.0;  ///< Relative growth rate of the half-angle; dissipation drives it.

  double half_angle_at_rad(double t_s) const {
    return half_angle_rad * std::exp(growth_per_s * t_s);
  }

  /// Returns how often the axis goes round the angular momentum per turn of the body.
  double per_turn() const {
    return inertia_ratio / (inertia_ratio + (1.0 - inertia_ratio) * std::cos(half_angle_rad));
  }
};

struct Coning {
  double tilt_rad = 0.0;     ///< Angle between the axes of symmetry and of the sensors, [0, pi/2).
  double azimuth_rad = 0.0;  ///< Azimuth behind slit 1 to which the sensors' axis leans.
};

/// Describes a spin that turns right-handed about the axis. The azimuth of slit 1 is counted about
/// the axis from the direction east of it (`tangent_basis`).
struct SpinMotion {
  Eigen::Vector3d axis_icrf;  ///< Spin axis, unit vector, ICRF.
  double rate_rad_s;          ///< Mean rate about the axis at the start; positive at all times.
  double rate_drift_rad_s2;
  double first_azimuth_rad;  ///< Azimuth of slit 1 at the start.
  Nutation nutation = {};
  Coning coning = {};

  /// Returns the azimuth that slit 1 would have in a uniform spin, not wrapped.
  double azimuth_rad(double t_s) const {
    return first_azimuth_rad + (rate_rad_s + 0.5 * rate_drift_rad_s2 * t_s) * t_s;
  }
  double rate_at_rad_s(double t_s) const { return rate_rad_s + rate_drift_rad_s2 * t_s; }
  static constexpr double end_s() { return std::numeric_limits<double>::infinity(); }

  /// Returns the tilt of the sensors' frame: R_axes_sensors = R_axes_tipped Rz(azimuth). It is
  /// exactly the identity without nutation and coning.
  Eigen::Matrix3d R_axes_tipped(double t_s) const {
    const double turned_rad = azimuth_rad(t_s) - first_azimuth_rad;
    return as_coned(nutation.half_angle_at_rad(t_s),
                    nutation.first_azimuth_rad + nutation.per_turn() * turned_rad) *
           as_coned(coning.tilt_rad, azimuth_rad(t_s) - coning.azimuth_rad);
  }

 private:
  /// Returns the rotation that tips the third axis towards the azimuth `towards_rad`.
  static Eigen::Matrix3d as_coned(double angle_rad, double towards_rad) {
    const Eigen::Vector3d hinge{-std::sin(towards_rad), std::cos(towards_rad), 0.0};
    return Eigen::AngleAxisd{angle_rad, hinge}.toRotationMatrix();
  }
};

}  // namespace spindrift
