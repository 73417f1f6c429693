/// @file
/// How many digits of a value its sigma leaves to be shown.

#pragma once

#include <algorithm>
#include <cmath>

namespace spindrift {

/// So many decimals that a sigma shows two digits, `least` of them at least.
inline int decimals_for(double sigma, int least) {
  constexpr int kMost = 12;
  return sigma > 0.0 && std::isfinite(sigma)
             ? static_cast<int>(std::clamp(1.0 - std::floor(std::log10(sigma)),
                                           static_cast<double>(least), static_cast<double>(kMost)))
             : least;
}

}  // namespace spindrift
