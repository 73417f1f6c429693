#include "pipelines/reconstruction/separation_record.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "pipelines/reconstruction/event_times.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/three_axis/sample_kind.h"
#include "pipelines/time/contested.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// @return True if no sample of that instant existed.
template <class Sample>
bool SeparationRecord::insert(std::vector<Sample>& samples, const Sample& sample) {
  const TaiTime separation = request_.times.separation;
  const auto place = std::upper_bound(samples.begin(), samples.end(), sample.t,
                                      [](TaiTime t, const Sample& other) { return t < other.t; });
  const bool is_there = (place != samples.begin() && std::prev(place)->t == sample.t) ||
                        std::get<Said<Sample>>(said_).contains(sample.t);
  if (sample.t < separation || span_between(separation, sample.t) > kLongest) {
    return false;
  }
  if (is_there) {
    contest(samples, sample);
    return false;
  }
  samples.insert(place, sample);
  if (!used_until_ || sample.t <= *used_until_) {
    newest_used_ = std::max(newest_used_.value_or(sample.t), sample.t);
  }
  return true;
}

/// Decides between the new sample and those of the same instant.
template <class Sample>
void SeparationRecord::contest(std::vector<Sample>& samples, const Sample& sample) {
  auto& of_kind = std::get<Said<Sample>>(said_);
  auto there = std::lower_bound(samples.begin(), samples.end(), sample.t,
                                [](const Sample& other, TaiTime t) { return other.t < t; });
  auto said = of_kind.find(sample.t);
  if (said == of_kind.end()) {
    if (say_the_same(*there, sample) && sample.sender != Sender::Preferred) {
      return;
    }
    said = of_kind.emplace(sample.t, std::vector<Sample>{*there}).first;
  }
  add_to(said->second, sample);
  const auto counts = one_that_counts(said->second);
  const bool is_there = there != samples.end() && there->t == sample.t;
  if (is_there == counts.has_value() && (!counts || say_the_same(*there, *counts))) {
    return;
  }
  if (was_due_ && !awaited_) {
    corrected_ = std::max(corrected_.value_or(sample.t), sample.t);
  }
  if (is_there) {
    there = samples.erase(there);
  }
  if (counts) {
    samples.insert(there, *counts);
  }
}

bool SeparationRecord::take_correction(std::chrono::nanoseconds apart) {
  if (!corrected_ || (last_correction_ &&
                      std::chrono::abs(span_between(*last_correction_, *corrected_)) < apart)) {
    return false;
  }
  last_correction_ = std::exchange(corrected_, std::nullopt);
  return true;
}

bool SeparationRecord::push(const GyroSample& sample) {
  return insert(request_.gyro, sample) && is_due(sample.t);
}

bool SeparationRecord::push(const SunDirection& sun) {
  if (request_.sensors.sun_sensor) {
    insert(request_.sun_directions, sun);
  }
  return false;
}

bool SeparationRecord::push(const TimedOrbitState& state) {
  insert(request_.orbit_states, state);
  return false;
}

bool SeparationRecord::push(const StarFix& fix) {
  if (!insert(request_.star_fixes, fix)) {
    return false;
  }
  const auto events = event_times(
      request_.times,
      {.gyro = request_.gyro, .sun = request_.sun_directions, .stars = request_.star_fixes});
  if (!events) {
    return false;
  }
  used_until_ = later_by_s(events->back().t, kUsedBehindFirstFix_s);
  const EventTime& before = *std::prev(events->end(), 2);
  if (before.event == SeparationEvent::Acquisition && !std::exchange(has_acquisition_, true)) {
    fixes_ = 0;
    due_at_fixes_ = 1;
  }
  if (fix.t < before.t || ++fixes_ < due_at_fixes_) {
    return false;
  }
  due_at_fixes_ = 2 * fixes_;
  awaited_ = std::max(fix.t, events->back().t);
  return is_due(later_by_s(request_.gyro.back().t, held_s(request_.gyro)));
}

bool SeparationRecord::fall_silent(std::chrono::nanoseconds apart) {
  if (std::exchange(corrected_, std::nullopt)) {
    return true;
  }
  if (!was_due_ || !newest_used_ ||
      (last_silence_ && std::chrono::abs(span_between(*last_silence_, *newest_used_)) < apart)) {
    return false;
  }
  last_silence_ = std::exchange(newest_used_, std::nullopt);
  return true;
}

bool SeparationRecord::forget(const Exclusions<SampleKind>& excluded) {
  const auto erase = [&](auto& samples) {
    return std::erase_if(
        samples, [&](const auto& sample) { return excluded.hold(sample.t, kind_of(sample)); });
  };
  const auto gone = erase(request_.gyro) + erase(request_.sun_directions) +
                    erase(request_.star_fixes) + erase(request_.orbit_states);
  return gone > 0 && was_due_ && !awaited_;
}

bool SeparationRecord::is_due(TaiTime reached) {
  const bool is_due = awaited_ && reached >= *awaited_;
  if (is_due) {
    was_due_ = true;
    corrected_.reset();
    newest_used_.reset();
    awaited_.reset();
  }
  return is_due;
}

}  // namespace spindrift
