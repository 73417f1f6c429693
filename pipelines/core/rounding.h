/// @file
/// Whether numbers that were sent twice are the same ones, written differently.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace spindrift {

/// A number printed with "%f" keeps so much: six digits behind the point. Float32 and longer texts
/// lose less.
inline constexpr double kSixDecimals = 1e-6;
/// A number printed with "%g" keeps this share of its largest power of ten: six digits in all.
inline constexpr double kSixDigits = 1e-5;

/// A sender that rounds to fewer digits than this says something else.
inline constexpr int kFewestDigits = 4;

/// Whether `coarse` is `fine`, rounded to four digits of its largest component or more: all its
/// components are multiples of one power of ten, and no further than half of that from `fine`.
template <int N>
bool is_rounded(const Eigen::Vector<double, N>& coarse, const Eigen::Vector<double, N>& fine) {
  // Float32 keeps seven digits.
  constexpr double kOfUnit = 1e-3;
  const double largest = coarse.cwiseAbs().maxCoeff();
  if (largest == 0.0) {
    return false;
  }
  const double first_digit = std::floor(std::log10(largest));
  for (const int digits : {kFewestDigits, kFewestDigits + 1}) {
    const double unit = std::pow(10.0, first_digit + 1 - digits);
    const Eigen::Array<double, N, 1> in_units = coarse.array() / unit;
    if ((in_units - in_units.round()).abs().maxCoeff() <= kOfUnit &&
        (coarse - fine).cwiseAbs().maxCoeff() <= (0.5 + kOfUnit) * unit) {
      return true;
    }
  }
  return false;
}

/// Compares the components of one vector, in one unit. Two are the same when one is the other
/// rounded to four or five digits, or when they differ by no more than one unit of the sixth digit
/// of the largest component, or of the sixth decimal where that is more.
template <int N>
bool same_but_for_rounding(const Eigen::Vector<double, N>& a, const Eigen::Vector<double, N>& b) {
  const double largest = std::min(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  const double digit =
      largest > 0.0 ? kSixDigits * std::pow(10.0, std::floor(std::log10(largest))) : 0.0;
  return (a - b).cwiseAbs().maxCoeff() <= std::max(kSixDecimals, digit) || is_rounded(a, b) ||
         is_rounded(b, a);
}

}  // namespace spindrift
