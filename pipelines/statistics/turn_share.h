/// @file
/// The share of bad items in the most recent turns of a spinner.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

namespace spindrift {

/// Counts items by turn. An item that arrives after one of a later turn counts for the later one,
/// as does an item without a turn.
class TurnShare {
 public:
  /// @param turns Length of the window.
  /// @param per_turn This many items without a turn are as long as a turn.
  TurnShare(int turns, std::size_t per_turn)
      : length_{static_cast<std::size_t>(turns)}, per_turn_{per_turn} {}

  /// Changes the length of the window; the turns counted so far stay.
  void set_turns(int turns) { length_ = static_cast<std::size_t>(turns); }

  /// @return Bad share of the turns so far in percent, if the item begins a new one and the window
  ///         is full.
  std::optional<double> count(std::optional<std::int64_t> turn, bool is_bad) {
    std::optional<double> percent;
    if (turns_.empty() || (turn ? *turn > last_ : turns_.back().without == per_turn_)) {
      percent = percent_of_window();
      turns_.push_back({});
      last_ = turn.value_or(last_);
    }
    Count& count = turns_.back();
    count.all += 1.0;
    count.bad += is_bad ? 1.0 : 0.0;
    count.without += turn ? 0 : 1;
    return percent;
  }

 private:
  struct Count {
    double all = 0.0;
    double bad = 0.0;
    std::size_t without = 0;
  };

  std::optional<double> percent_of_window() {
    if (turns_.size() < length_) {
      return std::nullopt;
    }
    turns_.erase(turns_.begin(), turns_.end() - static_cast<std::ptrdiff_t>(length_));
    Count sum;
    for (const Count& count : turns_) {
      sum.all += count.all;
      sum.bad += count.bad;
    }
    turns_.pop_front();
    return 100.0 * sum.bad / sum.all;
  }

  std::size_t length_;
  std::size_t per_turn_;
  std::deque<Count> turns_;
  std::int64_t last_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace spindrift
