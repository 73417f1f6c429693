/// @file
/// What share of the last revolutions, or of their edges, is bad.

#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace spindrift {

/// What counts for a revolution comes before anything of a later one, or is left out.
class RecentShare {
 public:
  explicit RecentShare(int revolutions) : revolutions_{static_cast<std::size_t>(revolutions)} {}

  /// @return the share in percent of the last revolutions before this one, where there are so many
  ///         and this one is new.
  std::optional<double> count(std::int64_t revolution, bool is_bad) {
    std::optional<double> percent;
    if (counts_.empty() || revolution > counts_.back().revolution) {
      percent = percent_of_window();
      counts_.push_back({.revolution = revolution});
      if (counts_.size() > revolutions_) {
        counts_.pop_front();
      }
    }
    Count& count = counts_.back();
    count.all += 1;
    count.bad += is_bad ? 1 : 0;
    return percent;
  }

 private:
  struct Count {
    std::int64_t revolution;
    int all = 0;
    int bad = 0;
  };

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
