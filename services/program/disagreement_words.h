/// @file
/// The sentence that says that two estimators disagree.

#pragma once

#include <string>

#include "services/archive/verdict.h"

namespace spindrift {

/// Returns for example "mean and batch disagree: their axes are 0.310 deg apart, 4.2 times the
/// larger sigma".
std::string sentence_of(const Disagreement& disagreement);

}  // namespace spindrift
