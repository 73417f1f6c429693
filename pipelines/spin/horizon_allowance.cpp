#include "pipelines/spin/horizon_allowance.h"

#include <cstddef>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {
namespace {

/// @param shift What each error of the model moves the axis by, for every radian of it.
Eigen::Matrix2d left_out_rad2(double disc_rad,
                              const Eigen::Matrix<double, 2, kModelErrors>& shift) {
  const double limb_rad = oblateness_rad(disc_rad);
  const Eigen::Vector2d north = shift.col(NorthLimb);
  const Eigen::Vector2d south = shift.col(SouthLimb);
  return (north * north.transpose() + south * south.transpose()) * (limb_rad * limb_rad / 3.0);
}

}  // namespace

SpinFix with_horizon_allowance(const Horizon& horizon, double disc_rad, SpinFix fix) {
  if (horizon.model == HorizonModel::Sphere) {
    return fix;
  }
  fix.covariance_rad2 +=
      left_out_rad2(disc_rad, tangent_basis(fix.axis_icrf).transpose() * fix.model_shift_icrf);
  for (std::size_t i = 0; i < fix.alternate_axes_icrf.size(); ++i) {
    fix.alternate_covariances_rad2[i] +=
        left_out_rad2(disc_rad, tangent_basis(fix.alternate_axes_icrf[i]).transpose() *
                                    fix.alternate_model_shifts_icrf[i]);
  }
  return fix;
}

}  // namespace spindrift
