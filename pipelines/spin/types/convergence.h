/// @file
/// How much an answer must have seen before its own data can have contradicted it.

#pragma once

#include "pipelines/core/assessment.h"

namespace spindrift {

/// The first twenty turns of a body that nutates by a degree look like those of another axis, and
/// watches for misplaced sensors and false first fixes need some turns to see them.
inline constexpr double kFewestRevolutionsToCheck = 30.0;

/// Of an answer that nothing speaks against.
/// @param revolutions That it has seen since it began, or began anew.
constexpr Quality unopposed_quality(double revolutions) {
  return revolutions < kFewestRevolutionsToCheck ? Quality::Converging : Quality::Ok;
}

}  // namespace spindrift
