#include "pipelines/ground_model/separation/separation_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipelines/ephemeris/sun.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

Vector3d relay_torque_nm(const SimpleControl& control, const Vector3d& rate_rad_s) {
  return rate_rad_s.unaryExpr([&](double w_rad_s) {
    return std::abs(w_rad_s) > control.dead_band_rad_s ? -std::copysign(control.torque_nm, w_rad_s)
                                                       : 0.0;
  });
}

/// The rate that turns -Z to the Sun by the short way: the slower the nearer, the fastest where the
/// Sun is behind.
Vector3d wanted_rate_rad_s(const SimpleControl& control, const Vector3d& sun_body) {
  constexpr double kPerRadian_1_s = 0.03;
  const Vector3d across = -Vector3d::UnitZ().cross(sun_body);
  if (sun_body.z() < 0.0) {
    const Vector3d rate_rad_s = kPerRadian_1_s * across;
    return rate_rad_s * std::min(1.0, control.slew_rad_s / std::max(rate_rad_s.norm(), 1e-12));
  }
  // With the Sun right behind any axis is as good.
  return control.slew_rad_s * (across + 1e-3 * Vector3d::UnitX()).normalized();
}

Vector3d acquisition_torque_nm(const SimpleControl& control, const BodyMotion& motion,
                               const Vector3d& sun_body) {
  constexpr double kPerSecond = 0.1;
  const Vector3d off_rad_s = wanted_rate_rad_s(control, sun_body) - motion.last().rate_body_rad_s;
  const Vector3d torque_nm = motion.body().inertia_kg_m2() * (kPerSecond * off_rad_s);
  return torque_nm.cwiseMax(-control.torque_nm).cwiseMin(control.torque_nm);
}

}  // namespace

Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit) {
  // Tells instants that are multiples of the step from the steps before.
  constexpr double kRounding_s = 1e-6;
  const auto body = RigidBody::make(truth.inertia_kg_m2);
  if (!body) {
    return Unexpected{body.error()};
  }
  BodyMotion motion{*body, truth.at_separation, kControlStep_s};
  ApparentSun sun;
  const auto steps = static_cast<std::int64_t>(std::ceil(truth.phases.end_s / kControlStep_s));
  for (std::int64_t i = 0; i < steps; ++i) {
    const double t_s = kControlStep_s * static_cast<double>(i) + kRounding_s;
    if (t_s < truth.phases.control_on_s) {
      motion.step({});
    } else if (t_s < truth.phases.acquisition_s) {
      motion.step({.external_nm = relay_torque_nm(truth.control, motion.last().rate_body_rad_s)});
    } else {
      const TaiTime t = shifted(truth.separation, t_s);
      const auto spacecraft = orbit.at(t);
      if (!spacecraft) {
        return Unexpected{spacecraft.error()};
      }
      const Vector3d sun_body =
          motion.last().q_icrf_body.conjugate() * sun.direction_icrf(t, *spacecraft);
      motion.step({.external_nm = acquisition_torque_nm(truth.control, motion, sun_body)});
    }
  }
  return motion;
}

}  // namespace spindrift
