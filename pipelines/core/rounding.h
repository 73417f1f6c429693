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

/// A sender that rounds to fewer digits than this says something else.
inline constexpr int kFewestDigits = 4;

/// @return The largest of the absolute values.
template <std::size_t N>
double largest_of(const std::array<double, N>& values) {
  double largest = 0.0;
  for (const double value : values) {
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

/// @return The largest difference between two components of the same place.
template <std::size_t N>
double most_apart(const std::array<double, N>& a, const std::array<double, N>& b) {
  double apart = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    apart = std::max(apart, std::abs(a[i] - b[i]));
  }
  return apart;
}

/// Whether `coarse` is `fine`, rounded to four digits of its largest component or more: all its
/// components are multiples of one power of ten, and no further than half of that from `fine`.
template <std::size_t N>
bool is_rounded(const std::array<double, N>& coarse, const std::array<double, N>& fine) {
  // Float32 keeps seven digits.
  constexpr double kOfUnit = 1e-3;
  const double largest = largest_of(coarse);
  if (largest == 0.0) {
    return false;
  }
  const double first_digit = std::floor(std::log10(largest));
  for (const int digits : {kFewestDigits, kFewestDigits + 1}) {
    const double unit = std::pow(10.0, first_digit + 1 - digits);
    const bool is_multiple = std::all_of(coarse.begin(), coarse.end(), [unit](double value) {
      return std::abs(value / unit - std::round(value / unit)) <= kOfUnit;
    });
    if (is_multiple && most_apart(coarse, fine) <= (0.5 + kOfUnit) * unit) {
      return true;
    }
  }
  return false;
}

/// Compares the components of one vector, in one unit. Two are the same when one is the other
/// rounded to four or five digits, or when they differ by no more than one unit of the sixth digit
/// of the largest component, or of the sixth decimal where that is more.
template <std::size_t N>
bool same_but_for_rounding(const std::array<double, N>& a, const std::array<double, N>& b) {
  const double largest = std::min(largest_of(a), largest_of(b));
  const double digit =
      largest > 0.0 ? kSixDigits * std::pow(10.0, std::floor(std::log10(largest))) : 0.0;
  return most_apart(a, b) <= std::max(kSixDecimals, digit) || is_rounded(a, b) || is_rounded(b, a);
}

}  // namespace spindrift
