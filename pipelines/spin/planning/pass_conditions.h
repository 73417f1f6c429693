/// @file
/// What a person should know of an instant of a coming pass. Codes with values; the sentences are
/// made of them in services/geometry.

#pragma once

#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/spin/planning/pass_geometry.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

enum class PassConditionCode {
  OneAxis,          ///< geometry_case; likewise the following of fixes
  SeveralAxes,      ///< -
  NoFixInLine,      ///< -
  NoFixNoise,       ///< -
  NoFixBothChords,  ///< -
  NoFixSunAngle,    ///< -
  NoFixOneChord,    ///< -
  NoFixNothing,     ///< -
  SunHidden,        ///< -
  SunNearAxis,      ///< -
  SunOutsideSlit2,  ///< -
  InLine,           ///< -
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

/// One for each thing that holds; free of values that change from one instant to the next, so that
/// a condition stays equal while it holds.
std::vector<PassCondition> conditions_of(const SpinConfig& config, const PassGeometry& geometry);

}  // namespace spindrift
