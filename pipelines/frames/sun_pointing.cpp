#include "pipelines/frames/sun_pointing.h"

#include <fmt/format.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/shortest_turn.h"

namespace spindrift {
namespace {

constexpr double kAcross = 1e-9;

Unexpected refused(ErrorCode code, const SunPointing& pointing, const char* why) {
  return Unexpected{
      {code, fmt::format("sun-pointing angles phi {:.6f}, theta {:.6f} deg {}",
                         degrees(pointing.phi_rad), degrees(pointing.theta_rad), why)}};
}

}  // namespace

SunPointing sun_pointing_of(const Eigen::Vector3d& sun_body) {
  return {.phi_rad = -std::atan2(sun_body.y(), -sun_body.z()),
          .theta_rad = std::atan2(sun_body.x(), -sun_body.z())};
}

Expected<Eigen::Vector3d> sun_body_of(const SunPointing& pointing) {
  const double cos_phi = std::cos(pointing.phi_rad);
  const double cos_theta = std::cos(pointing.theta_rad);
  if (std::abs(cos_phi) < kAcross || std::abs(cos_theta) < kAcross) {
    return refused(ErrorCode::Unobservable, pointing,
                   "give no direction: at +-90 deg they are the same all round");
  }
  if (std::signbit(cos_phi) != std::signbit(cos_theta)) {
    return refused(ErrorCode::InvalidInput, pointing,
                   "contradict each other: both must be within 90 deg, or both beyond");
  }
  const Eigen::Vector3d along{std::sin(pointing.theta_rad) * cos_phi,
                              -std::sin(pointing.phi_rad) * cos_theta, -cos_theta * cos_phi};
  return (std::signbit(cos_phi) ? -along : along).normalized();
}

Eigen::Quaterniond turned_least(const Eigen::Quaterniond& q_ref_body, const Eigen::Vector3d& ref,
                                const Eigen::Vector3d& body) {
  const Eigen::Vector3d expected_body = q_ref_body.conjugate() * ref;
  return q_ref_body * shortest_turn(body, expected_body);
}

Expected<Eigen::Quaterniond> attitude_with(const SunPointing& pointing,
                                           const Eigen::Quaterniond& q_ref_body,
                                           const Eigen::Vector3d& sun_ref) {
  return sun_body_of(pointing).map(
      [&](const Eigen::Vector3d& sun_body) { return turned_least(q_ref_body, sun_ref, sun_body); });
}

}  // namespace spindrift
