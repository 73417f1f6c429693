/// @file
/// What an operator may say of a spinner's telemetry from some instant on.

#pragma once

#include <Eigen/Core>
#include <variant>

#include "pipelines/exclusions/channel_actions.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Of the axes that a revolution leaves possible the nearest is the true one.
struct ChooseRoot {
  Eigen::Vector3d axis_icrf;  ///< Unit.
};

/// In the place of the mission's.
struct SetPrior {
  SpinPrior prior;
};

/// The axis is no longer where edges from before had it.
struct MarkManoeuvre {};

/// Where the axis should be; no estimate depends on it.
struct SetTarget {
  Eigen::Vector3d axis_icrf;  ///< Unit.
};

using SpinAction =
    std::variant<ExcludeChannel<PulseChannel>, IncludeChannel<PulseChannel>,
                 ExcludeSegment<PulseChannel>, ChooseRoot, SetPrior, MarkManoeuvre, SetTarget>;

}  // namespace spindrift
