#include "pipelines/ground_model/control/gyro_propagation.h"

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// Returns twice dq/dt. @param q Quaternion in the order x, y, z, w.
Vector4d twice_change(const Vector4d& q, const Vector3d& rate_rad_s) {
  Quaterniond rate{0.0, 0.0, 0.0, 0.0};
  rate.vec() = rate_rad_s;
  return (Quaterniond{q} * rate).coeffs();
}

Quaterniond runge_kutta(const Quaterniond& q_icrf_body, const RateSpan& span) {
  const double h_s = span.dt_s;
  const Vector4d& q = q_icrf_body.coeffs();
  const Vector3d middle_rad_s = 0.5 * (span.from_rad_s + span.to_rad_s);
  const Vector4d first = twice_change(q, span.from_rad_s);
  const Vector4d second = twice_change(q + 0.25 * h_s * first, middle_rad_s);
  const Vector4d third = twice_change(q + 0.25 * h_s * second, middle_rad_s);
  const Vector4d fourth = twice_change(q + 0.5 * h_s * third, span.to_rad_s);
  return Quaterniond{Vector4d{q + h_s / 12.0 * (first + 2.0 * (second + third) + fourth)}}
      .normalized();
}

}  // namespace

Quaterniond propagated(GyroPropagation by, const Quaterniond& q_icrf_body, const RateSpan& span) {
  switch (by) {
    case GyroPropagation::Composition:
      return (q_icrf_body * quaternion_by(turned_rad(span, Vector3d::Zero()))).normalized();
    case GyroPropagation::RungeKutta:
      return runge_kutta(q_icrf_body, span);
  }
  return q_icrf_body;
}

}  // namespace spindrift
