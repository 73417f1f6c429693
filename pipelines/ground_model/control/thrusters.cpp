#include "pipelines/ground_model/control/thrusters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {

Expected<Thrusters> Thrusters::make(const ThrusterDesign& design) {
  // Written so that NaN fails.
  if (!(design.torque_nm > 0.0 && design.shortest_s > 0.0 &&
        design.longest_s >= design.shortest_s)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("thrusters of {} N m with pulses from {} to {} s: must be above 0, in order",
                     design.torque_nm, design.shortest_s, design.longest_s)}};
  }
  return Thrusters{design};
}

void Thrusters::command(const Eigen::Vector3d& torque_body_nm, double period_s) {
  const double longest_s = std::min(design_.longest_s, period_s);
  left_s_ = torque_body_nm.unaryExpr([&](double wanted_nm) {
    const double on_s = std::min(std::abs(wanted_nm) / design_.torque_nm * period_s, longest_s);
    return on_s < design_.shortest_s ? 0.0 : std::copysign(on_s, wanted_nm);
  });
}

BodyTorques Thrusters::step(double step_s) {
  const Eigen::Vector3d on_s = left_s_.cwiseMin(step_s).cwiseMax(-step_s);
  left_s_ -= on_s;
  return {.external_nm = design_.torque_nm / step_s * on_s};
}

}  // namespace spindrift
