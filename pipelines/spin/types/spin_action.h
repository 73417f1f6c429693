/// @file
/// Actions of an operator on the telemetry of a spinner from some instant on.

#pragma once

#include <Eigen/Core>
#include <variant>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// States that the true axis is the nearest to this of those that a revolution leaves possible.
struct ChooseRoot {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
};

/// Replaces the mission's prior.
struct SetPrior {
  SpinPrior prior;
};

/// Marks a manoeuvre: the axis is no longer where earlier edges had it.
struct MarkManoeuvre {};

/// Sets where the axis should be; no estimate depends on it.
struct SetTarget {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
};

using SpinAction =
    std::variant<ExcludeChannel<PulseChannel>, IncludeChannel<PulseChannel>,
                 ExcludeSegment<PulseChannel>, ChooseRoot, SetPrior, MarkManoeuvre, SetTarget>;

}  // namespace spindrift
