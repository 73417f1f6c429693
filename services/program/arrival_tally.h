/// @file
/// Counts the samples received from each spacecraft, for the status line.

#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/time/tai_time.h"
#include "services/archive/records.h"

namespace spindrift {

struct TalliedArrivals {
  std::string run_id = {};   ///< Run that the other members except `samples` describe.
  std::int64_t samples = 0;  ///< Number of edges (coded frames included) or sensor samples.
  std::optional<std::int64_t> revolution = {};    ///< Latest one known in the run.
  std::map<std::string_view, TaiTime> last = {};  ///< Last arrival by channel or kind of sensor.
};

/// Safe to use from any thread.
class ArrivalTally {
 public:
  /// Counts the samples and revolutions of `batch`; samples left out of processing are not counted.
  void count(const ArchiveBatch& batch);

  TalliedArrivals of(const std::string& spacecraft) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, TalliedArrivals> by_spacecraft_;
};

}  // namespace spindrift
