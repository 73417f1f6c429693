/// @file
/// Rounds a value to the digits that its sigma justifies.

#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spindrift {

/// Returns the number of decimals, at least `least`, that show two digits of a sigma.
inline int decimals_for(double sigma, int least) {
  constexpr int kMost = 12;
  return sigma > 0.0 && std::isfinite(sigma)
             ? static_cast<int>(std::clamp(1.0 - std::floor(std::log10(sigma)),
                                           static_cast<double>(least), static_cast<double>(kMost)))
             : least;
}

/// Formats a sigma, or another small value, to its own digits.
inline std::string to_its_digits(double sigma, int least) {
  return fmt::format("{:.{}f}", sigma, decimals_for(sigma, least));
}

/// Returns "0.2003 +/- 0.0012", to the digits that sigma justifies.
inline std::string with_sigma(double value, double sigma, int least) {
  const int decimals = decimals_for(sigma, least);
  return fmt::format("{:.{}f} +/- {:.{}f}", value, decimals, sigma, decimals);
}

/// Works as `with_sigma` and also shows the sign of a positive value.
inline std::string signed_with_sigma(double value, double sigma, int least) {
  return (std::signbit(value) ? "" : "+") + with_sigma(value, sigma, least);
}

}  // namespace spindrift
