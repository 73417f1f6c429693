/// @file
/// Coefficients of a main field's spherical harmonics, Schmidt semi-normalised.

#pragma once

#include <array>
#include <cstddef>

namespace spindrift {

inline constexpr int kHighestDegree = 13;
/// About which the harmonics are: the Earth's mean radius of the IGRF.
inline constexpr double kFieldRadius_km = 6371.2;

struct GaussCoefficients {
  static constexpr std::size_t kCount{(kHighestDegree + 1) * (kHighestDegree + 2) / 2};
  /// In `g_nt` and `h_nt`: degree by degree, in it by order. Degree 0 is there and 0.
  static constexpr std::size_t index(int degree, int order) {
    const int entry = degree * (degree + 1) / 2 + order;
    return static_cast<std::size_t>(entry);
  }

  std::array<double, kCount> g_nt{};
  std::array<double, kCount> h_nt{};  ///< 0 where the order is.
};

}  // namespace spindrift
