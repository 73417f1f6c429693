/// @file
/// Puts samples in telemetry time order, whatever their order of arrival.

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

/// Holds each sample until no earlier one is expected, that is until a sample arrives that is later
/// by the reorder horizon.
///
/// Samples far ahead of the others do not advance time, however many, because a sender with a bad
/// clock would make all true samples late. They are stray if time goes on without them for their
/// reorder horizon. If the stream goes on from them instead, the pass continues after a silence
/// (TimeJump). A few samples far before all others are left out as well.
/// @tparam Sample Totally ordered, first by its time `t`; equal ones are duplicates.
///         `reorder_horizon(sample)` gives the time to wait for earlier samples.
///         `kind_in_order(sample)`, below 64, gives the kind; each kind may have its own clock.
template <class Sample>
class BasicReorderWindow {
 public:
  /// Distance from all earlier samples above which a sample is far ahead.
  static constexpr std::chrono::nanoseconds kFarAhead = TimeJump::kFar;
  /// Fewer samples do not form a stream.
  static constexpr std::size_t kEnoughToAccept = TimeJump::kFewest;
  /// Time for which a released sample can be recognised as a duplicate; no sample waits longer.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  /// Largest number of samples held as far ahead, and as stray: those of a time jump until it is
  /// accepted, at 3 kHz.
  static constexpr std::size_t kMostFarAhead = 65'536;

  enum class Verdict { Held, Duplicate, Late, OutOfTime };

  /// Adds a sample. Duplicate: it is held, or was released within kRemembered. Late: later samples
  /// have been released. OutOfTime: it is far ahead, and too many others are too.
  Verdict offer(const Sample& sample);

  /// The sample that another duplicates, and whether it was released; null if there is none.
  struct Known {
    const Sample* sample;
    bool released;
  };
  Known find(const Sample& sample) const;

  /// Returns the samples that are due, in time order.
  std::vector<Sample> release();

  /// Releases all held samples that are in time, because the stream has fallen silent. Those far
  /// ahead stay. Before any time is accepted, too few samples release nothing, because it is
  /// unknown which clock is right.
  std::vector<Sample> fall_silent();

  struct Rest {
    std::vector<Sample> in_time;      ///< Samples in order of time.
    std::vector<Sample> out_of_time;  ///< Far ahead or far before, and too few to be accepted.
  };
  /// Ends the pass and returns all samples that are held.
  Rest release_all();

 private:
  bool is_far_ahead(const Sample& sample) const;
  /// Returns whether no time has been accepted yet.
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
  std::map<Sample, TaiTime> far_ahead_;  ///< Each with the newest time at its arrival.
  std::set<Sample> stray_;               ///< Samples far ahead that time went on without.
  TimeJump jump_;
  std::vector<Sample> early_;    ///< Too few samples, far before the first accepted ones.
  std::vector<Sample> due_;      ///< Samples from before an accepted jump.
  std::deque<Sample> released_;  ///< In time order; the remembered ones, at least the last one.
};

/// Duplicates change no state, because a restarted service does not read them back.
template <class Sample>
typename BasicReorderWindow<Sample>::Verdict BasicReorderWindow<Sample>::offer(
    const Sample& sample) {
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
  jump_.add_ahead(sample.t, kind_in_order(sample));
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

/// Moves samples far ahead to the stray ones when their reorder horizon has passed without a jump.
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

/// Accepts a jump: held samples become due, or are set aside as early if they were never accepted.
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

/// Sets aside the first few samples if nothing is accepted yet and enough others follow far behind.
/// @return True if any were set aside.
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
    // An initial sample with a bad clock does not release others either.
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

/// @return First sample that is far ahead of its predecessors and too few to form a stream.
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

/// @return Kinds of the held samples from `first` on, as bits.
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
