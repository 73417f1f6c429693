/// @file
/// What share of the last revolutions, or of their edges, is bad.

#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// What counts for a revolution comes before anything of a later one, or is left out. What has no
/// revolution counts for the last one.
class RecentShare {
 public:
  /// As many without a revolution, one edge of each channel, are a turn of their own.
  static constexpr int kOfATurn = static_cast<int>(kPulseChannels);

  explicit RecentShare(int revolutions) : revolutions_{static_cast<std::size_t>(revolutions)} {}

  /// @return the share in percent of the last revolutions before this one, where there are so many
  ///         and this one is new.
  std::optional<double> count(std::int64_t revolution, bool is_bad) {
    std::optional<double> percent;
    if (counts_.empty() || revolution > counts_.back().revolution) {
      percent = begin(revolution);
    }
    Count& count = counts_.back();
    count.all += 1;
    count.bad += is_bad ? 1 : 0;
    return percent;
  }

  /// Of an edge that found no revolution: it is bad.
  std::optional<double> count_without_revolution() {
    std::optional<double> percent;
    if (counts_.empty() || counts_.back().without == kOfATurn) {
      percent = begin(counts_.empty() ? std::numeric_limits<std::int64_t>::min()
                                      : counts_.back().revolution);
    }
    Count& count = counts_.back();
    count.without += 1;
    count.all += 1;
    count.bad += 1;
    return percent;
  }

 private:
  struct Count {
    std::int64_t revolution;
    int all = 0;
    int bad = 0;
    int without = 0;  ///< Revolution; of the bad ones.
  };

  std::optional<double> begin(std::int64_t revolution) {
    const auto percent = percent_of_window();
    counts_.push_back({.revolution = revolution});
    if (counts_.size() > revolutions_) {
      counts_.pop_front();
    }
    return percent;
  }

  std::optional<double> percent_of_window() const {
    if (counts_.size() < revolutions_) {
      return std::nullopt;
    }
    int all = 0;
    int bad = 0;
    for (const Count& count : counts_) {
      all += count.all;
      bad += count.bad;
    }
    return 100.0 * bad / all;
  }

  std::size_t revolutions_;
  std::deque<Count> counts_;
};

}  // namespace spindrift
