#include "pipelines/ground_model/dynamics/body_spin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Returns the turn about the third axis, in [-2 pi, 2 pi].
double turned_rad(const Quaterniond& q_axes_sensors) {
  return 2.0 * std::atan2(q_axes_sensors.z(), q_axes_sensors.w());
}

Vector3d momentum_icrf_nms(const BodyMotion& motion) {
  const BodyState start = motion.at(0.0);
  return start.q_icrf_body * Vector3d{motion.body().inertia_kg_m2() * start.rate_body_rad_s};
}

}  // namespace

BodySpin::BodySpin(BodyMotion&& motion, Quaterniond q_body_sensors)
    : axis_icrf{momentum_icrf_nms(motion).normalized()},
      motion_{std::move(motion)},
      q_body_sensors_{std::move(q_body_sensors)} {
  Matrix3d R_icrf_axes;
  R_icrf_axes << tangent_basis(axis_icrf), axis_icrf;
  q_axes_icrf_ = Quaterniond{R_icrf_axes.transpose()};
}

Expected<BodySpin> BodySpin::make(BodyMotion motion, const Quaterniond& q_body_sensors) {
  if (const auto fine = check_step(motion.step_s(), motion.at(0.0).rate_body_rad_s.norm()); !fine) {
    return Unexpected{fine.error()};
  }
  BodySpin spin{std::move(motion), q_body_sensors};
  const double step_s = spin.motion_.step_s();
  const auto steps = static_cast<std::size_t>(std::llround(spin.end_s() / step_s));
  double before_rad = turned_rad(spin.q_axes_sensors(0.0));
  for (std::size_t i = 0; i <= steps; ++i) {
    const double t_s = step_s * static_cast<double>(i);
    const Quaterniond q_axes_sensors = spin.q_axes_sensors(t_s);
    const double lean_rad =
        angle_between_rad(Vector3d::UnitZ(), q_axes_sensors * Vector3d::UnitZ());
    if (!(lean_rad < kQuarter_rad)) {
      return Unexpected{{ErrorCode::InvalidConfiguration,
                         fmt::format("the sensors' axis leans away from the angular momentum by "
                                     "{:.1f} deg {} s behind the start: must be below 90 deg",
                                     degrees(lean_rad), t_s)}};
    }
    before_rad += std::remainder(turned_rad(q_axes_sensors) - before_rad, kTurn_rad);
    spin.azimuths_rad_.push_back(before_rad);
  }
  return spin;
}

std::size_t BodySpin::step_at(double t_s) const {
  const double step = std::max(0.0, t_s / motion_.step_s());
  return std::min(static_cast<std::size_t>(step), azimuths_rad_.size() - 1);
}

Quaterniond BodySpin::q_axes_sensors(double t_s) const {
  return q_axes_icrf_ * motion_.at(t_s).q_icrf_body * q_body_sensors_;
}

double BodySpin::azimuth_rad(double t_s) const {
  const double near_rad = azimuths_rad_[step_at(t_s)];
  return near_rad + std::remainder(turned_rad(q_axes_sensors(t_s)) - near_rad, kTurn_rad);
}

double BodySpin::rate_at_rad_s(double t_s) const {
  const std::size_t step = std::min(step_at(t_s), azimuths_rad_.size() - 2);
  return (azimuths_rad_[step + 1] - azimuths_rad_[step]) / motion_.step_s();
}

Matrix3d BodySpin::R_axes_tipped(double t_s) const {
  const Quaterniond q = q_axes_sensors(t_s);
  return (q * Eigen::AngleAxisd{-turned_rad(q), Vector3d::UnitZ()}).toRotationMatrix();
}

}  // namespace spindrift
