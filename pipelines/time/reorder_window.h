/// @file
/// Telemetry time orders the samples, whatever order they arrive in.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_jump.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// Holds samples until nothing earlier is to be expected: until one arrives that is the sample's
/// horizon of telemetry time younger.
///
/// Samples far ahead of the others do not advance time, however many, since a sender with a bad
/// clock would make all true ones late. They are stray when time goes on without them for as long
/// as they are waited for; when the stream goes on from them instead, the pass continues after a
/// silence (TimeJump). Likewise a few samples far before all others are left out.
/// @tparam Sample Totally ordered, first by its time `t`; equal ones are duplicates.
///         `reorder_horizon(sample)` says how long is waited for what precedes it, and
///         `kind_in_order(sample)`, below 64, which of the kinds it is that may have clocks of
///         their own.
template <class Sample>
class BasicReorderWindow {
 public:
  /// Further than this ahead of all that came before is far.
  static constexpr std::chrono::nanoseconds kFarAhead = TimeJump::kFar;
  /// Fewer are no stream by themselves.
  static constexpr std::size_t kEnoughToAccept = TimeJump::kFewest;
  /// How long a released sample is known again: longer than any waits to be settled.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  /// No more than this are kept waiting to be accepted, and as many that are stray: what a jump of
  /// time takes to be believed, at 3 kHz.
  static constexpr std::size_t kMostFarAhead = 65'536;

  enum class Verdict { Held, Duplicate, Late, OutOfTime };

  /// Takes a sample in. Duplicate: it is held, or was released within kRemembered. Late: what comes
  /// after it has been released already. OutOfTime: far ahead, as too many before it.
  Verdict add(const Sample& sample);

  /// The one that `sample` is a duplicate of, and whether it was released; null: none is known.
  struct Known {
    const Sample* sample;
    bool released;
  };
  Known find(const Sample& sample) const;

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
  /// No time has been accepted that there were anything to say for.
  bool is_beginning() const { return released_.empty() && held_.size() < kEnoughToAccept; }
  bool is_first() const { return released_.empty() && held_.empty(); }
  TaiTime newest() const { return held_.empty() ? released_.back().t : held_.rbegin()->t; }
  void leave_stray_behind();
  void accept_jump();
  bool set_aside_early();
  typename std::set<Sample>::const_iterator end_in_time() const;
  std::uint64_t kinds_from(typename std::set<Sample>::const_iterator first) const;
  void remember(const Sample& sample);

  std::set<Sample> held_;
  std::map<Sample, TaiTime> far_ahead_;  ///< And how far time had come when each arrived.
  std::set<Sample> stray_;               ///< Far ahead, and time has gone on without them.
  TimeJump jump_;
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
    jump_.hear(kind_in_order(sample));
    leave_stray_behind();
    return Verdict::Held;
  }
  if (stray_.contains(sample) || far_ahead_.contains(sample)) {
    return Verdict::Duplicate;
  }
  if (std::max(far_ahead_.size(), stray_.size()) >= kMostFarAhead) {
    return Verdict::OutOfTime;
  }
  far_ahead_.emplace(sample, newest());
  jump_.see(sample.t, kind_in_order(sample));
  if (jump_.has_shown() || (is_beginning() && jump_.could_be())) {
    accept_jump();
  }
  return Verdict::Held;
}

template <class Sample>
typename BasicReorderWindow<Sample>::Known BasicReorderWindow<Sample>::find(
    const Sample& sample) const {
  for (const std::set<Sample>* held : {&held_, &stray_}) {
    if (const auto found = held->find(sample); found != held->end()) {
      return {.sample = &*found, .released = false};
    }
  }
  if (const auto found = far_ahead_.find(sample); found != far_ahead_.end()) {
    return {.sample = &found->first, .released = false};
  }
  const auto found = std::lower_bound(released_.begin(), released_.end(), sample);
  return {.sample = found != released_.end() && *found == sample ? &*found : nullptr,
          .released = true};
}

template <class Sample>
bool BasicReorderWindow<Sample>::is_far_ahead(const Sample& sample) const {
  return !is_first() && span_between(newest(), sample.t) > kFarAhead;
}

/// Those that came so long ago that nothing is waited for any more which would precede them.
template <class Sample>
void BasicReorderWindow<Sample>::leave_stray_behind() {
  for (auto far = far_ahead_.begin(); far != far_ahead_.end();) {
    const auto& [sample, since] = *far;
    if (later_by(since, reorder_horizon(sample)) <= newest()) {
      stray_.insert(sample);
      far = far_ahead_.erase(far);
    } else {
      ++far;
    }
  }
}

/// Time has jumped: what was held before is due, or was never accepted itself.
template <class Sample>
void BasicReorderWindow<Sample>::accept_jump() {
  if (is_beginning()) {
    early_.insert(early_.end(), held_.begin(), held_.end());
    held_.clear();
  }
  for (const Sample& sample : std::exchange(held_, {})) {
    due_.push_back(sample);
    remember(sample);
  }
  for (const auto& [sample, since] : std::exchange(far_ahead_, {})) {
    (jump_.holds(sample.t) ? held_ : stray_).insert(sample);
  }
  jump_.accept();
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

/// @return The first of those that are far ahead of all before and no stream by themselves.
template <class Sample>
typename std::set<Sample>::const_iterator BasicReorderWindow<Sample>::end_in_time() const {
  std::size_t left = held_.size();
  for (auto sample = held_.begin(); sample != held_.end(); ++sample, --left) {
    const bool is_first = sample == held_.begin();
    if (is_first && released_.empty()) {
      continue;
    }
    const TaiTime before = is_first ? released_.back().t : std::prev(sample)->t;
    if (span_between(before, sample->t) > kFarAhead && !jump_.is_enough(left, kinds_from(sample))) {
      return sample;
    }
  }
  return held_.end();
}

/// @return The kinds of those that are held from there on, as bits.
template <class Sample>
std::uint64_t BasicReorderWindow<Sample>::kinds_from(
    typename std::set<Sample>::const_iterator first) const {
  return std::accumulate(first, held_.end(), std::uint64_t{0},
                         [](std::uint64_t kinds, const Sample& sample) {
                           return kinds | TimeJump::bit_of(kind_in_order(sample));
                         });
}

template <class Sample>
typename BasicReorderWindow<Sample>::Rest BasicReorderWindow<Sample>::release_all() {
  if (jump_.could_be()) {
    accept_jump();
  }
  Rest rest{.in_time = std::exchange(due_, {}), .out_of_time = {}};
  while (set_aside_early()) {
  }
  const auto end = end_in_time();
  rest.in_time.insert(rest.in_time.end(), held_.cbegin(), end);
  rest.out_of_time = std::exchange(early_, {});
  rest.out_of_time.insert(rest.out_of_time.end(), end, held_.cend());
  for (const auto& [sample, since] : std::exchange(far_ahead_, {})) {
    stray_.insert(sample);
  }
  rest.out_of_time.insert(rest.out_of_time.end(), stray_.begin(), stray_.end());
  for (auto sample = held_.cbegin(); sample != end; ++sample) {
    remember(*sample);
  }
  held_.clear();
  stray_.clear();
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
