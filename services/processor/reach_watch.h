/// @file
/// The reach of a run's samples, their gaps, and their share of the planned contact.

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>

#include "pipelines/supervision/limits.h"
#include "pipelines/time/tai_time.h"
#include "services/archive/records.h"

namespace spindrift {

class ReachWatch {
 public:
  /// While samples come, the stored end of the run lags behind them by at most this: the row of a
  /// run is wide, and is not rewritten for every sample.
  static constexpr std::chrono::minutes kFollows{1};
  static constexpr std::chrono::seconds kSpan{10};
  /// Within a pass no sensor is silent for as long as this.
  static constexpr std::chrono::minutes kSilence{5};

  /// Spans of telemetry time without a sample, each longer than kSilence.
  struct Silences {
    std::int64_t count = 0;
    TaiTime longest_from = {};
    TaiTime longest_to = {};
  };

  explicit ReachWatch(std::optional<Contact> contact) : contact_{contact} {}

  /// Counts a sample in, whether or not its time turns out to be right.
  void include(TaiTime t);
  /// Notes that the pass has reached `t` (PassWatch). A sample with a wrong time does not get here.
  void carry_on(TaiTime t);

  /// Returns the reach if it differs enough from the one taken last; otherwise empty.
  std::optional<RunReach> take_news();
  /// Returns the reach of a run that ends; empty when it had no sample.
  std::optional<RunReach> take_last();
  const Silences& silences() const { return silences_; }

 private:
  RunReach reach() const;

  std::optional<Contact> contact_;
  std::optional<TaiTime> first_;  ///< Empty before the first sample.
  std::optional<TaiTime> last_;   ///< Time that the pass has reached.
  std::set<std::int64_t> spans_;  ///< Indices of contact spans with samples, from 0.
  Silences silences_;
  std::optional<RunReach> stored_;
};

}  // namespace spindrift
