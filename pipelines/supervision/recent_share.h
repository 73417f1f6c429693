/// @file
/// Computes the share of bad items in the most recent revolutions or their edges.

#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Counts items by revolution. Items of a revolution that arrive after one of a later revolution
/// count for the later one, as do items without a revolution.
class RecentShare {
 public:
  /// This many items without a revolution, one edge of each channel, count as a revolution.
  static constexpr int kOfATurn = static_cast<int>(kPulseChannels);

  explicit RecentShare(int revolutions) : revolutions_{static_cast<std::size_t>(revolutions)} {}

  /// @return Bad share of the previous revolutions in percent, if this revolution is new and the
  ///         window is full.
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

  /// Counts an edge without a revolution as bad.
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
    int without = 0;  ///< Bad items without a revolution.
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
