/// @file
/// The Earth's main magnetic field, that of its core, at one date.
///
///     B = -grad V,  V = a sum_n (a/r)^(n+1) sum_m (g_nm cos m l + h_nm sin m l) P_nm(sin b)
///
/// with a = 6371.2 km, latitude b, longitude l, and Schmidt's semi-normalised P_nm. The sum is in
/// Cartesian components by Cunningham's recursion (Montenbruck and Gill 2000, eq. 3.29 to 3.33),
/// which divides by r only and so has no singularity at the poles.
///
/// Crust and currents add 30 nT on a quiet day, and turn the field by a degree and more under an
/// aurora; they are not modelled.
///
/// GeographicLib's SphericalHarmonic was rejected: with the same coefficients it is slower by a
/// factor of 1.7 (tests/bench), and its table would be shared by threads. The tests compare with it
/// to 1e-12.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/frames/local_frame.h"
#include "pipelines/geomagnetism/gauss_coefficients.h"

namespace spindrift {

class MainField {
 public:
  /// Radius below which the sources of the field lie and the sum has no meaning.
  static constexpr double kCoreRadius_km = 3480.0;

  /// @param degree Highest degree of the sum, 1 to kHighestDegree.
  MainField(const GaussCoefficients& coefficients, int degree);

  /// @return Field in ITRF, nT; InvalidInput within the core and for a position that is not finite.
  Expected<Eigen::Vector3d> at(const Eigen::Vector3d& position_itrf_km) const;

  /// @return Field north, east, down, nT; InvalidInput as for `at`.
  Expected<Eigen::Vector3d> ned_at(const LocalFrame& frame) const;

 private:
  GaussCoefficients unnormalised_;
  int degree_;
};

}  // namespace spindrift
