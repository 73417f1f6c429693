#include "pipelines/reconstruction/shared_errors.h"

namespace spindrift {

SharedCovariance prior_of(double bias_sigma_rad_s, const AttitudeAlignment& alignment) {
  SharedCovariance prior = SharedCovariance::Zero();
  prior.diagonal().segment<3>(SharedGyroBias).setConstant(bias_sigma_rad_s * bias_sigma_rad_s);
  prior(kOfFile, kOfFile) = alignment(kOfAlignment, kOfAlignment);
  return prior;
}

PerGyroError measured_per_gyro_error(const Eigen::Vector3d& rate_body_rad_s) {
  const double x = rate_body_rad_s.x();
  const double y = rate_body_rad_s.y();
  const double z = rate_body_rad_s.z();
  PerGyroError slopes;
  slopes << x, 0.0, 0.0, y, z, 0.0, 0.0, 0.0, 0.0,  //
      0.0, y, 0.0, 0.0, 0.0, x, z, 0.0, 0.0,        //
      0.0, 0.0, z, 0.0, 0.0, 0.0, 0.0, x, y;
  return slopes;
}

}  // namespace spindrift
