/// @file
/// Determines the epochs T1 to T4 from the mission file or, where it omits them, from the samples.

#pragma once

#include <span>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

struct EventTime {
  SeparationEvent event;
  TaiTime t;
  bool found;
};

/// Holds the samples, each kind in time order.
struct SamplesInOrder {
  std::span<const GyroSample> gyro;
  std::span<const SunDirection> sun;
  std::span<const StarFix> stars;
};

/// Returns the error that there is no star fix after `t`.
Error nothing_anchored(TaiTime t);

/// Returns the events T1, T2, T3 (if a sun vector shows it) and T4; see SeparationTimes.
/// @return Unobservable without gyro samples or without a star fix for T4; InvalidInput if the
///         events are out of order.
Expected<std::vector<EventTime>> event_times(const SeparationTimes& times,
                                             const SamplesInOrder& samples);

}  // namespace spindrift
