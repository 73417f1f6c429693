/// @file
/// The Earth's main magnetic field of one date: what its core makes.
///
///     B = -grad V,  V = a sum_n (a/r)^(n+1) sum_m (g_nm cos m l + h_nm sin m l) P_nm(sin b)
///
/// with a = 6371.2 km, latitude b, longitude l, and Schmidt's semi-normalised P_nm. Summed in
/// Cartesian components by Cunningham's recursion (Montenbruck and Gill 2000, eq. 3.29 to 3.33),
/// which divides by r only: a pole is a place like any other.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/frames/local_frame.h"
#include "pipelines/geomagnetism/gauss_coefficients.h"

namespace spindrift {

class MainField {
 public:
  /// The sources of the field are below; the sum means nothing there.
  static constexpr double kCoreRadius_km = 3480.0;

  /// @param degree Up to which is summed, 1 to kHighestDegree.
  MainField(const GaussCoefficients& coefficients, int degree);

  /// @return ITRF, nT; InvalidInput within the core and for what is no number.
  Expected<Eigen::Vector3d> at(const Eigen::Vector3d& position_itrf_km) const;

  /// @return north, east, down, nT; InvalidInput likewise.
  Expected<Eigen::Vector3d> ned_at(const LocalFrame& frame) const;

 private:
  GaussCoefficients unnormalised_;
  int degree_;
};

}  // namespace spindrift
