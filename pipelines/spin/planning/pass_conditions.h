/// @file
/// Conditions that a person should know at an instant of a coming pass, as codes with values;
/// services/reports makes the sentences of them.

#pragma once

#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/spin/planning/pass_geometry.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Condition codes with the names of their values; those without a comment have none.
enum class PassConditionCode {
  OneAxis,          ///< geometry_case
  SeveralAxes,      ///< geometry_case
  NoFixInLine,      ///< geometry_case
  NoFixNoise,       ///< geometry_case
  NoFixBothChords,  ///< geometry_case
  NoFixSunAngle,    ///< geometry_case
  NoFixOneChord,    ///< geometry_case
  NoFixNothing,     ///< geometry_case
  SunHidden,
  SunNearAxis,
  SunOutsideSlit2,
  InLine,
  BeamMisses,       ///< beam
  BeamNearTangent,  ///< beam
  BeamCrosses,      ///< beam
  BeamInside,       ///< beam
  ChordTwoRoots,    ///< beam, determinant_usable
  ChordAmbiguous,   ///< beam, determinant_ambiguous
  ChannelsMeet,     ///< one, other
};
inline constexpr int kPassConditionCodes = static_cast<int>(PassConditionCode::ChannelsMeet) + 1;

using PassCondition = Coded<PassConditionCode>;

/// Returns one condition for each fact that holds, without values that change from one instant to
/// the next, so that a condition stays equal while it holds.
std::vector<PassCondition> conditions_of(const SpinConfig& config, const PassGeometry& geometry);

}  // namespace spindrift
