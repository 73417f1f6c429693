/// @file
/// Spherical harmonic coefficients of a main field, Schmidt semi-normalised.

#pragma once

#include <array>
#include <cstddef>

namespace spindrift {

inline constexpr int kHighestDegree = 13;
/// Reference radius of the harmonics: the Earth's mean radius of the IGRF.
inline constexpr double kFieldRadius_km = 6371.2;

struct GaussCoefficients {
  static constexpr std::size_t kCount{(kHighestDegree + 1) * (kHighestDegree + 2) / 2};
  /// Returns the index in `g_nt` and `h_nt`, by degree, then order; degree 0 is included.
  static constexpr std::size_t index(int degree, int order) {
    const int entry = degree * (degree + 1) / 2 + order;
    return static_cast<std::size_t>(entry);
  }

  std::array<double, kCount> g_nt{};
  std::array<double, kCount> h_nt{};  ///< Coefficients h; 0 for order 0.
};

}  // namespace spindrift
