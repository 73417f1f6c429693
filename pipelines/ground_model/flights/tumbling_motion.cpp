#include "pipelines/ground_model/flights/tumbling_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/control/held_momentum.h"
#include "pipelines/ground_model/dynamics/coarse_step.h"

namespace spindrift {
namespace {

/// Returns a step of which the flight is a whole multiple.
double step_s(double end_s, double fastest_rad_s) {
  constexpr double kTurn_rad = 0.01;
  constexpr double kLongest_s = 1.0;
  const double wanted_s = std::min(kLongest_s, kTurn_rad / std::max(fastest_rad_s, 1e-6));
  return end_s / std::ceil(end_s / wanted_s);
}

}  // namespace

Expected<BodyMotion> tumbling_motion(const TumblingTruth& truth, const Orbit& orbit) {
  const auto body = RigidBody::make(truth.body.inertia_kg_m2);
  if (!body) {
    return Unexpected{body.error()};
  }
  const double fastest = fastest_rad_s(truth.body.inertia_kg_m2,
                                       truth.body.at_start.rate_body_rad_s, truth.wheels_body_nms);
  if (const auto fine = check_step(kLongestStep_s, fastest); !fine) {
    return Unexpected{fine.error()};
  }
  ClosedLoop<BodyMotion> loop{
      BodyMotion{*body, truth.body.at_start, step_s(truth.body.end_s, fastest)},
      HeldMomentum{truth.wheels_body_nms}, truth.body.disturbances, 1};
  return fly(loop, truth.body, orbit,
             [](TaiTime, const OrbitState&) { return Eigen::Vector3d::Zero().eval(); })
      .map([&] { return std::move(loop).body(); });
}

}  // namespace spindrift
