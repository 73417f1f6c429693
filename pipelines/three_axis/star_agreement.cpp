#include "pipelines/three_axis/star_agreement.h"

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/three_axis/innovation_record.h"

namespace spindrift {

bool StarAgreement::note(const ObservedAttitude& fix) {
  const double variance_rad2 = fix.sigma_rad * fix.sigma_rad;
  int agreeing = 1;
  if (last_) {
    const double apart_rad = angle_between_rad(last_->q_icrf_body, fix.q_icrf_body);
    if (apart_rad * apart_rad <=
        innovation_gate(3) * (last_->error.variance_rad2() + variance_rad2)) {
      agreeing += last_->agreeing;
    }
  }
  last_ = {
      .q_icrf_body = fix.q_icrf_body, .error = {.noise_rad2 = variance_rad2}, .agreeing = agreeing};
  return agreeing >= kEnough;
}

void StarAgreement::turn(const Eigen::Vector3d& turned_rad, const CarryError& error) {
  if (last_) {
    last_->q_icrf_body = (last_->q_icrf_body * quaternion_by(turned_rad)).normalized();
    last_->error.add(error);
  }
}

}  // namespace spindrift
