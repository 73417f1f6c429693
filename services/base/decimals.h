/// @file
/// Rounds a value to the digits that its sigma justifies, as the page does (text.js).

#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spindrift {

/// Returns the number of decimals that show two digits of a sigma.
/// @param otherwise Number of decimals where there is no sigma.
inline int decimals_for(double sigma, int otherwise) {
  constexpr double kMost = 12.0;
  return sigma > 0.0 && std::isfinite(sigma)
             ? static_cast<int>(std::clamp(1.0 - std::floor(std::log10(sigma)), 0.0, kMost))
             : otherwise;
}

/// Formats a sigma, or another small value, to its own digits.
inline std::string to_its_digits(double sigma, int otherwise) {
  return fmt::format("{:.{}f}", sigma, decimals_for(sigma, otherwise));
}

/// Returns "0.2003 +/- 0.0012", to the digits that sigma justifies.
inline std::string with_sigma(double value, double sigma, int otherwise) {
  const int decimals = decimals_for(sigma, otherwise);
  return fmt::format("{:.{}f} +/- {:.{}f}", value, decimals, sigma, decimals);
}

/// Works as `with_sigma` and also shows the sign of a positive value.
inline std::string signed_with_sigma(double value, double sigma, int otherwise) {
  return (std::signbit(value) ? "" : "+") + with_sigma(value, sigma, otherwise);
}

}  // namespace spindrift
