/// @file
/// The main geomagnetic field computed with GeographicLib (Clenshaw summation), independent of the
/// project's own.

#pragma once

#include <Eigen/Core>
#include <GeographicLib/SphericalHarmonic.hpp>
#include <vector>

#include "pipelines/geomagnetism/main_field.h"

namespace spindrift::testing {

class GeographicLibField {
 public:
  GeographicLibField(const GaussCoefficients& coefficients, int degree)
      : g_nt_{by_order(coefficients.g_nt, 0)},
        h_nt_{by_order(coefficients.h_nt, 1)},
        potential_{g_nt_,
                   h_nt_,
                   kHighestDegree,
                   degree,
                   degree,
                   kFieldRadius_km,
                   GeographicLib::SphericalHarmonic::SCHMIDT} {}
  GeographicLibField(const GeographicLibField&) = delete;
  GeographicLibField& operator=(const GeographicLibField&) = delete;

  /// Returns the field in ITRF, nT.
  Eigen::Vector3d at(const Eigen::Vector3d& position_itrf_km) const {
    Eigen::Vector3d slope;
    potential_(position_itrf_km.x(), position_itrf_km.y(), position_itrf_km.z(), slope.x(),
               slope.y(), slope.z());
    return -kFieldRadius_km * slope;
  }

 private:
  /// Returns the coefficients sorted by order m, as GeographicLib expects them.
  static std::vector<double> by_order(
      const std::array<double, GaussCoefficients::kCount>& coefficients, int first) {
    std::vector<double> ordered;
    for (int m = first; m <= kHighestDegree; ++m) {
      for (int n = m; n <= kHighestDegree; ++n) {
        ordered.push_back(coefficients.at(GaussCoefficients::index(n, m)));
      }
    }
    return ordered;
  }

  std::vector<double> g_nt_;
  std::vector<double> h_nt_;
  GeographicLib::SphericalHarmonic potential_;
};

}  // namespace spindrift::testing
