/// @file
/// When T1 to T4 are: as the mission says, and what it leaves out as the samples show it.

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

/// Each kind in order of time.
struct SamplesInOrder {
  std::span<const GyroSample> gyro;
  std::span<const SunDirection> sun;
  std::span<const StarFix> stars;
};

/// That no star fix lies behind `t`.
Error nothing_anchored(TaiTime t);

/// T1, T2, T3 where a sun vector shows it, T4; see SeparationTimes.
/// @return Unobservable where there is no gyro sample, or no star fix to find T4 by; InvalidInput
///         where one is before another.
Expected<std::vector<EventTime>> event_times(const SeparationTimes& times,
                                             const SamplesInOrder& samples);

}  // namespace spindrift
