/// @file
/// How many revolutions an estimate needs before its own data could have contradicted it.

#pragma once

#include "pipelines/core/assessment.h"

namespace spindrift {

/// The first twenty turns of a body that nutates by a degree look like those of another axis, and
/// the tests for misplaced sensors and false first fixes need some turns.
inline constexpr double kFewestRevolutionsToCheck = 30.0;

/// Returns the quality of an estimate that nothing contradicts.
/// @param revolutions Revolutions seen since the estimate began, or began anew.
constexpr Quality unopposed_quality(double revolutions) {
  return revolutions < kFewestRevolutionsToCheck ? Quality::Converging : Quality::Ok;
}

}  // namespace spindrift
