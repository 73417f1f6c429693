/// @file
/// Two estimators that give axes which their sigmas do not explain, and the sentence for people.

#pragma once

#include <string>

namespace spindrift {

struct Disagreement {
  std::string one;  ///< Estimators, as in spin_estimate.
  std::string other;
  double apart_deg;
  double apart_sigmas;  ///< The larger of the two, for they share their edges.
};

/// "mean and batch disagree: their axes are 0.310 deg apart, 4.2 times the larger sigma".
std::string sentence_of(const Disagreement& disagreement);

}  // namespace spindrift
