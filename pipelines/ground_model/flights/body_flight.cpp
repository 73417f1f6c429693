#include "pipelines/ground_model/flights/body_flight.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

double fastest_rad_s(const Eigen::Matrix3d& inertia_kg_m2, const Eigen::Vector3d& rate_body_rad_s,
                     const Eigen::Vector3d& wheels_body_nms) {
  const Eigen::Vector3d moments = inertia_kg_m2.selfadjointView<Eigen::Lower>().eigenvalues();
  return rate_body_rad_s.norm() * std::sqrt(moments[2] / moments[0]) +
         wheels_body_nms.norm() / moments[0];
}

double least_moment_kg_m2(const Eigen::Matrix3d& inertia_kg_m2) {
  return inertia_kg_m2.selfadjointView<Eigen::Lower>().eigenvalues()[0];
}

Expected<void> check_now(const ClosedLoop<BodyMotion>& loop, double least_moment_kg_m2) {
  const Eigen::Vector3d rate_body_rad_s = loop.body().last().rate_body_rad_s;
  if (!rate_body_rad_s.allFinite()) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("{:.1f} s behind the start a torque on the body is not finite: see "
                     "[disturbances]",
                     loop.t_s())}};
  }
  const double fastest =
      rate_body_rad_s.norm() + loop.wheels_body_nms().norm() / least_moment_kg_m2;
  return check_step(loop.body().step_s(), fastest).map_error([&](Error&& error) {
    return Error{error.code,
                 fmt::format("{:.1f} s behind the start the body turns by {:.4g} deg/s, its wheels "
                             "hold {:.3g} N m s: torques spin it up, or do not hold it: {}",
                             loop.t_s(), kDegPerRad * rate_body_rad_s.norm(),
                             loop.wheels_body_nms().norm(), error.message)};
  });
}

Expected<ClosedLoop<BodyMotion>> loop_of(const BodyTruth& truth, const Actuators& actuators,
                                         double period_s) {
  const int steps = static_cast<int>(std::ceil(period_s / kLongestStep_s));
  const double step_s = period_s / steps;
  const auto body = RigidBody::make(truth.inertia_kg_m2);
  if (!body) {
    return Unexpected{body.error()};
  }
  if (const auto fine =
          check_step(step_s, fastest_rad_s(truth.inertia_kg_m2, truth.at_start.rate_body_rad_s,
                                           wheels_body_nms(actuators)));
      !fine) {
    return Unexpected{fine.error()};
  }
  return ClosedLoop<BodyMotion>{BodyMotion{*body, truth.at_start, step_s}, actuators,
                                truth.disturbances, steps};
}

Expected<Surroundings> SurroundingsOnTheWay::at(TaiTime t) {
  constexpr double kField_s = 1.0;
  return orbit_.at(t).and_then([&](const OrbitState& spacecraft) -> Expected<Surroundings> {
    if (truth_.field && (!field_of_ || seconds_between(*field_of_, t) >= kField_s)) {
      const auto field = field_icrf_nt(*truth_.field, t, spacecraft.position_icrf_km, earth_);
      if (!field) {
        return Unexpected{field.error()};
      }
      field_icrf_nt_ = *field;
      field_of_ = t;
    }
    return Surroundings{.spacecraft = spacecraft, .field_icrf_nt = field_icrf_nt_};
  });
}

}  // namespace spindrift
