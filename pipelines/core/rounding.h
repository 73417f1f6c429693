/// @file
/// Whether numbers that were sent twice are the same ones, written differently.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace spindrift {

/// A number printed with "%f" keeps so much: six digits behind the point. Float32 and longer texts
/// lose less.
inline constexpr double kSixDecimals = 1e-6;
/// A number printed with "%g" keeps this share of its largest power of ten: six digits in all.
inline constexpr double kSixDigits = 1e-5;

/// Of the components of one vector, in one unit. They are told apart from one unit of the sixth
/// digit of the largest component on, or of the sixth decimal where that is more: rounding is half
/// of it.
template <std::size_t N>
bool same_but_for_rounding(const std::array<double, N>& a, const std::array<double, N>& b) {
  double largest_a = 0.0;
  double largest_b = 0.0;
  double apart = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    largest_a = std::max(largest_a, std::abs(a[i]));
    largest_b = std::max(largest_b, std::abs(b[i]));
    apart = std::max(apart, std::abs(a[i] - b[i]));
  }
  const double largest = std::min(largest_a, largest_b);
  const double digit =
      largest > 0.0 ? kSixDigits * std::pow(10.0, std::floor(std::log10(largest))) : 0.0;
  return apart <= std::max(kSixDecimals, digit);
}

}  // namespace spindrift
