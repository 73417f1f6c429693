#include "pipelines/frames/uncertain_attitude.h"

#include <Eigen/Cholesky>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {

/// Works in the axes of `a`, into which the errors of `b` are rotated.
Expected<AttitudeDifference> attitude_difference(const UncertainAttitude& a,
                                                 const UncertainAttitude& b) {
  const Eigen::Quaterniond q_a_b = a.q_ref_body.conjugate() * b.q_ref_body;
  const Eigen::Matrix3d R_a_b = q_a_b.toRotationMatrix();
  const Eigen::Vector3d apart_rad = rotation_vector_of(q_a_b);
  const Eigen::LLT<Eigen::Matrix3d> covariance{a.covariance_rad2 +
                                               R_a_b * b.covariance_rad2 * R_a_b.transpose()};
  if (covariance.info() != Eigen::Success) {
    return Unexpected{{ErrorCode::InvalidInput,
                       "the covariance of the difference of two attitudes is not positive "
                       "definite: give each a sigma above 0 deg"}};
  }
  return AttitudeDifference{.angle_rad = apart_rad.norm(),
                            .chi_square = apart_rad.dot(covariance.solve(apart_rad))};
}

}  // namespace spindrift
