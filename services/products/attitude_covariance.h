/// @file
/// Reads the covariance of an attitude from its columns.

#pragma once

#include <Eigen/Core>

#include "services/base/degrees.h"

namespace spindrift {

/// Reads the columns cov_xx_deg2 to cov_zz_deg2.
template <class Row>
Eigen::Matrix3d attitude_covariance_rad2_of(const Row& row) {
  const double xy = row.real("cov_xy_deg2");
  const double xz = row.real("cov_xz_deg2");
  const double yz = row.real("cov_yz_deg2");
  Eigen::Matrix3d deg2;
  deg2 << row.real("cov_xx_deg2"), xy, xz, xy, row.real("cov_yy_deg2"), yz, xz, yz,
      row.real("cov_zz_deg2");
  return deg2 * (kRadPerDeg * kRadPerDeg);
}

}  // namespace spindrift
