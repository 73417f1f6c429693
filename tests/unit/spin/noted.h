/// @file
/// Monitors of the sequential estimator that have seen the same revolution many times.

#pragma once

#include "pipelines/spin/sequential/spin_filter.h"

namespace spindrift::testing {

template <class Monitor>
void note(Monitor& monitor, int revolutions, const EdgeStatistics& tally) {
  for (int i = 0; i < revolutions; ++i) {
    monitor.note(tally);
  }
}

template <class Monitor>
Monitor noted(int revolutions, const EdgeStatistics& tally) {
  Monitor monitor;
  note(monitor, revolutions, tally);
  return monitor;
}

}  // namespace spindrift::testing
