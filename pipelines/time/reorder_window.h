/// @file
/// Telemetry time orders the samples, whatever order they arrive in.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// Holds samples until nothing earlier is to be expected: until one arrives that is the sample's
/// horizon of telemetry time younger.
///
/// One sample far ahead of the others does not advance time, since a sender with a bad clock would
/// make all true ones late; several in a row do: the pass continues after a silence. Likewise a few
/// samples far before all others are left out.
/// @tparam Sample Totally ordered, first by its time `t`; equal ones are duplicates.
///         `reorder_horizon(sample)` says how long is waited for what precedes it.
template <class Sample>
class BasicReorderWindow {
 public:
  /// Further than this ahead of all that came before is far.
  static constexpr std::chrono::nanoseconds kFarAhead{std::chrono::minutes{1}};
  /// So many far ones in a row are accepted.
  static constexpr std::size_t kEnoughToAccept = 8;
  /// How long a released sample is known again: longer than any waits to be settled.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  /// No more than this are kept waiting to be accepted.
  static constexpr std::size_t kMostFarAhead = 4096;

  enum class Verdict { Held, Duplicate, Late, OutOfTime };

  /// Takes a sample in. Duplicate: it is held, or was released within kRemembered. Late: what comes
  /// after it has been released already. OutOfTime: far ahead, as too many before it.
  Verdict add(const Sample& sample);

  /// Samples whose turn has come, in order.
  std::vector<Sample> release();

  /// The stream has fallen silent: all that are held in time, as if younger samples had come. Those
  /// far ahead stay set aside. While nothing is accepted yet and too few are in time, none: nobody
  /// can tell whose clock is right.
  std::vector<Sample> fall_silent();

  struct Rest {
    std::vector<Sample> in_time;      ///< In order.
    std::vector<Sample> out_of_time;  ///< Far ahead or far before, and too few to be accepted.
  };
  /// All that are held: the pass has ended.
  Rest release_all();

 private:
  bool is_far_ahead(const Sample& sample) const;
  void accept_jump();
  bool set_aside_early();
  typename std::set<Sample>::const_iterator end_in_time() const;
  void remember(const Sample& sample);

  std::set<Sample> held_;
  std::set<Sample> far_ahead_;
  std::size_t far_in_a_row_ = 0;
  std::vector<Sample> early_;    ///< Too few, and far before the first accepted ones.
  std::vector<Sample> due_;      ///< Before a jump that was accepted.
  std::deque<Sample> released_;  ///< In order; those remembered, at least the last one.
};

/// A duplicate changes nothing, since it is not among the samples that a restarted service reads
/// back.
template <class Sample>
typename BasicReorderWindow<Sample>::Verdict BasicReorderWindow<Sample>::add(const Sample& sample) {
  if (!released_.empty() && sample <= released_.back()) {
    const bool known = std::binary_search(released_.begin(), released_.end(), sample);
    return known ? Verdict::Duplicate : Verdict::Late;
  }
  if (!is_far_ahead(sample)) {
    if (!held_.insert(sample).second) {
      return Verdict::Duplicate;
    }
    far_in_a_row_ = 0;
    return Verdict::Held;
  }
  if (far_ahead_.size() >= kMostFarAhead) {
    return Verdict::OutOfTime;
  }
  if (!far_ahead_.insert(sample).second) {
    return Verdict::Duplicate;
  }
  if (++far_in_a_row_ >= kEnoughToAccept) {
    accept_jump();
  }
  return Verdict::Held;
}

template <class Sample>
bool BasicReorderWindow<Sample>::is_far_ahead(const Sample& sample) const {
  if (!released_.empty()) {
    const TaiTime newest = held_.empty() ? released_.back().t : held_.rbegin()->t;
    return span_between(newest, sample.t) > kFarAhead;
  }
  return !held_.empty() && span_between(held_.rbegin()->t, sample.t) > kFarAhead;
}

/// Time has jumped: what was held before is due, or was never accepted itself.
template <class Sample>
void BasicReorderWindow<Sample>::accept_jump() {
  if (released_.empty() && held_.size() < kEnoughToAccept) {
    early_.insert(early_.end(), held_.begin(), held_.end());
    held_.clear();
  }
  for (const Sample& sample : std::exchange(held_, std::exchange(far_ahead_, {}))) {
    due_.push_back(sample);
    remember(sample);
  }
  far_in_a_row_ = 0;
}

/// Nothing is accepted yet, and the first few are far before enough others to be.
/// @return Whether any were set aside.
template <class Sample>
bool BasicReorderWindow<Sample>::set_aside_early() {
  if (!released_.empty() || held_.size() <= kEnoughToAccept) {
    return false;
  }
  auto end = std::next(held_.begin());
  std::size_t before = 1;
  while (end != held_.end() && before < kEnoughToAccept &&
         span_between(std::prev(end)->t, end->t) <= kFarAhead) {
    ++end;
    ++before;
  }
  if (before >= kEnoughToAccept || held_.size() - before < kEnoughToAccept) {
    return false;
  }
  early_.insert(early_.end(), held_.begin(), end);
  held_.erase(held_.begin(), end);
  return true;
}

template <class Sample>
std::vector<Sample> BasicReorderWindow<Sample>::release() {
  std::vector<Sample> due = std::exchange(due_, {});
  while (!held_.empty()) {
    const Sample first = *held_.begin();
    Sample due_by{};
    due_by.t = later_by(first.t, reorder_horizon(first));
    const auto younger = held_.lower_bound(due_by);
    // A sample of a bad clock that was there first does not count either.
    if (younger == held_.end() || span_between(first.t, younger->t) > kFarAhead) {
      if (set_aside_early()) {
        continue;
      }
      break;
    }
    due.push_back(first);
    remember(first);
    held_.erase(held_.begin());
  }
  return due;
}

template <class Sample>
std::vector<Sample> BasicReorderWindow<Sample>::fall_silent() {
  std::vector<Sample> due = release();
  const auto end = end_in_time();
  if (released_.empty() &&
      std::distance(held_.cbegin(), end) < static_cast<std::ptrdiff_t>(kEnoughToAccept)) {
    return due;
  }
  for (auto sample = held_.cbegin(); sample != end; ++sample) {
    due.push_back(*sample);
    remember(*sample);
  }
  held_.erase(held_.cbegin(), end);
  return due;
}

/// @return The first of too few to be accepted that are far ahead of all before.
template <class Sample>
typename std::set<Sample>::const_iterator BasicReorderWindow<Sample>::end_in_time() const {
  std::size_t left = held_.size();
  for (auto sample = held_.begin(); sample != held_.end(); ++sample, --left) {
    const bool is_first = sample == held_.begin();
    if (is_first && released_.empty()) {
      continue;
    }
    const TaiTime before = is_first ? released_.back().t : std::prev(sample)->t;
    if (span_between(before, sample->t) > kFarAhead && left < kEnoughToAccept) {
      return sample;
    }
  }
  return held_.end();
}

template <class Sample>
typename BasicReorderWindow<Sample>::Rest BasicReorderWindow<Sample>::release_all() {
  Rest rest{.in_time = std::exchange(due_, {}), .out_of_time = {}};
  held_.merge(far_ahead_);
  while (set_aside_early()) {
  }
  const auto end = end_in_time();
  rest.in_time.insert(rest.in_time.end(), held_.cbegin(), end);
  rest.out_of_time = std::exchange(early_, {});
  rest.out_of_time.insert(rest.out_of_time.end(), end, held_.cend());
  for (auto sample = held_.cbegin(); sample != end; ++sample) {
    remember(*sample);
  }
  held_.clear();
  far_ahead_.clear();
  return rest;
}

template <class Sample>
void BasicReorderWindow<Sample>::remember(const Sample& sample) {
  released_.push_back(sample);
  while (span_between(released_.front().t, sample.t) > kRemembered) {
    released_.pop_front();
  }
}

}  // namespace spindrift
