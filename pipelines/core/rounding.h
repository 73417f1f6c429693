/// @file
/// Decides whether a number sent twice is the same one, written differently.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace spindrift {

/// Resolution of a number printed with "%f": six decimals. Float32 and longer texts are finer.
inline constexpr double kSixDecimals = 1e-6;
/// Resolution of a number printed with "%g", relative to its leading power of ten: six digits.
inline constexpr double kSixDigits = 1e-5;

/// Coarser rounding than to this many digits counts as a different value.
inline constexpr int kFewestDigits = 4;

/// Returns whether `coarse` is `fine`, rounded to at least four digits of its largest component:
/// its components are multiples of one power of ten and within half of that from `fine`.
template <int N>
bool is_rounded(const Eigen::Vector<double, N>& coarse, const Eigen::Vector<double, N>& fine) {
  // Float32 keeps seven digits, so that a multiple may be off by this part of the unit.
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

/// Compares the components of one vector, all in one unit. Two vectors are the same if one is the
/// other rounded to four or five digits, or if they differ by at most one unit of the sixth digit
/// of the largest component or of the sixth decimal, whichever is larger.
template <int N>
bool same_but_for_rounding(const Eigen::Vector<double, N>& a, const Eigen::Vector<double, N>& b) {
  const double largest = std::min(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  const double digit =
      largest > 0.0 ? kSixDigits * std::pow(10.0, std::floor(std::log10(largest))) : 0.0;
  return (a - b).cwiseAbs().maxCoeff() <= std::max(kSixDecimals, digit) || is_rounded(a, b) ||
         is_rounded(b, a);
}

}  // namespace spindrift
