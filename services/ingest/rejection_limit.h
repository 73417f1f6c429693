/// @file
/// Limits how many impossible samples are stored: a sender may be faulty for days.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/telemetry/rejected_input.h"

namespace spindrift {

/// Stores the first kKept impossible samples of each source in a minute, which begins with the
/// first of them. The rest of the minute becomes one row with their number and the reason of the
/// last. Sources beyond kMaxSources in a minute are limited together, under kOtherSources.
/// Minutes are measured by the wall clock on arrival, because the samples' own times may be what is
/// impossible. A sample sent again after a restart may therefore be stored where it was only
/// counted before, or the reverse; rejected input does not enter any computation.
class RejectionLimit {
 public:
  static constexpr std::int64_t kKept = 20;
  static constexpr std::size_t kMaxSources = 256;

  /// @param now Wall clock.
  /// @return `rejected`, or empty when it is only counted.
  std::optional<RejectedInput> pass(RejectedInput rejected, TaiTime now);

  /// Returns one row per source with samples that were only counted, once the minute is over at
  /// `now`. To be called regularly.
  std::vector<RejectedInput> take_rest(TaiTime now);

 private:
  struct Minute {
    std::int64_t kept = 0;
    std::int64_t counted = 0;  ///< Number of samples that were only counted.
    RejectedInput last = {};   ///< The last of these.
  };

  Minute& minute_of(const std::string& source);

  TaiTime began_;
  std::map<std::string, Minute> sources_;
};

}  // namespace spindrift
