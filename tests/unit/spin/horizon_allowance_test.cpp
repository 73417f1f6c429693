#include "pipelines/spin/horizon_allowance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {
namespace {

constexpr double kDisc_rad = 0.35;

SpinFix fix_moved_by_limbs(double north, double south) {
  SpinFix fix{.revolution = 0,
              .t = {},
              .geometry_case = 1,
              .axis_icrf = Eigen::Vector3d{1.0, 2.0, 2.0}.normalized(),
              .covariance_rad2 = 1e-8 * Eigen::Matrix2d::Identity(),
              .alternate_axes_icrf = {},
              .resolution = Resolution::Geometry,
              .norm = 1.0,
              .accepted = true};
  const auto basis = tangent_basis(fix.axis_icrf);
  fix.model_shift_icrf.col(NorthLimb) = north * basis.col(0);
  fix.model_shift_icrf.col(SouthLimb) = south * basis.col(1);
  return fix;
}

TEST(HorizonAllowance, TheSphereLeavesNothingOut) {
  const SpinFix fix = fix_moved_by_limbs(3.0, 4.0);
  EXPECT_EQ(with_horizon_allowance({HorizonModel::Sphere, 40.0}, kDisc_rad, fix).covariance_rad2,
            fix.covariance_rad2);
}

TEST(HorizonAllowance, EachLimbAddsAUniformErrorOfItsWholeDisplacement) {
  SpinFix fix = fix_moved_by_limbs(3.0, 4.0);
  fix.alternate_axes_icrf = {fix.axis_icrf};
  fix.alternate_covariances_rad2 = {fix.covariance_rad2};
  fix.alternate_model_shifts_icrf = {2.0 * fix.model_shift_icrf};
  const SpinFix allowed = with_horizon_allowance({HorizonModel::Ellipsoid, 40.0}, kDisc_rad, fix);
  const double limb_rad2 = std::pow(oblateness_rad(kDisc_rad), 2) / 3.0;
  const Eigen::Matrix2d added = Eigen::Vector2d{9.0 * limb_rad2, 16.0 * limb_rad2}.asDiagonal();
  EXPECT_TRUE(allowed.covariance_rad2.isApprox(fix.covariance_rad2 + added, 1e-12));
  EXPECT_TRUE(allowed.alternate_covariances_rad2.front().isApprox(fix.covariance_rad2 + 4.0 * added,
                                                                  1e-12));
}

}  // namespace
}  // namespace spindrift
