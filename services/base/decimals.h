/// @file
/// How many digits of a value its sigma leaves to be shown.

#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spindrift {

/// So many decimals that a sigma shows two digits, `least` of them at least.
inline int decimals_for(double sigma, int least) {
  constexpr int kMost = 12;
  return sigma > 0.0 && std::isfinite(sigma)
             ? static_cast<int>(std::clamp(1.0 - std::floor(std::log10(sigma)),
                                           static_cast<double>(least), static_cast<double>(kMost)))
             : least;
}

/// A sigma, or another small value, by itself.
inline std::string to_its_digits(double sigma, int least) {
  return fmt::format("{:.{}f}", sigma, decimals_for(sigma, least));
}

/// "0.2003 +/- 0.0012", to the digits that sigma leaves.
inline std::string with_sigma(double value, double sigma, int least) {
  const int decimals = decimals_for(sigma, least);
  return fmt::format("{:.{}f} +/- {:.{}f}", value, decimals, sigma, decimals);
}

/// Likewise with the sign of the value.
inline std::string signed_with_sigma(double value, double sigma, int least) {
  return (std::signbit(value) ? "" : "+") + with_sigma(value, sigma, least);
}

}  // namespace spindrift
