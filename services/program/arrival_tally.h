/// @file
/// What has come of each spacecraft, for those who watch.

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
  std::string run_id = {};   ///< Of which all but `samples` is.
  std::int64_t samples = 0;  ///< Edges, those of coded frames too; or samples of sensors.
  std::optional<std::int64_t> revolution = {};    ///< The last that is known of the run.
  std::map<std::string_view, TaiTime> last = {};  ///< By channel, or by kind of sensor.
};

/// Used by any thread.
class ArrivalTally {
 public:
  /// Its samples and revolutions; of samples that are left out none.
  void note(const ArchiveBatch& batch);

  TalliedArrivals of(const std::string& spacecraft) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, TalliedArrivals> by_spacecraft_;
};

}  // namespace spindrift
