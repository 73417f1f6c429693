/// @file
/// What a mission file may be off by: [spin.alignment], [three_axis.alignment] and [calibration].

#pragma once

#include <string>
#include <vector>

#include "pipelines/spin/types/alignment.h"
#include "pipelines/three_axis/alignment.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"
#include "services/mission/schema.h"
#include "services/mission/spacecraft_kind.h"

namespace spindrift {

/// Returns the covariance that the alignment keys state. [calibration] takes the place of those
/// that it names; what it does not name is uncorrelated with what it names.
/// @param values Values of a mission file without problems.
SpinAlignment spin_alignment(const TomlValues& values);
AttitudeAlignment three_axis_alignment(const TomlValues& values);

/// A key of alignment that counts though the mission file does not say it.
struct DefaultSigma {
  std::string key;  ///< Dotted.
  double value;     ///< In the unit of the key.
  int error;        ///< Index of the first error whose sigma it is.
};

/// Returns the keys that stand at their default, of sensors that the mission has and not taken the
/// place of by [calibration].
/// @param document Valid.
std::vector<DefaultSigma> default_sigmas(const TomlDocument& document, SpacecraftKind kind);

/// Adds the problems of [calibration] that the schema cannot express: names of nothing that this
/// spacecraft may be off by, and a matrix that is no covariance of them.
/// @param document Valid by the schema.
void check_calibration(TomlDocument& document, const TableRule& schema, SpacecraftKind kind);

}  // namespace spindrift
