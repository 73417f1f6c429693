#include "services/ingest/writing_order.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace spindrift {
namespace {

// The number of sessions that the bus is required to tell apart.
constexpr std::size_t kMostSessions = 256;

constexpr auto kEarlier = [](const auto& a, const auto& b) { return a.place < b.place; };

template <class Samples>
void move_all(Samples& from, Samples& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
  from.clear();
}

BatchPlace last_written(const TelemetrySamples& samples) {
  BatchPlace last{std::numeric_limits<std::int64_t>::min()};
  samples.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      last = std::max(last, sample.place);
    }
  });
  return last;
}

/// Sorts by time of writing, because DDS delivers a topic spacecraft by spacecraft.
void sort_if_of_several_kinds(TelemetrySamples& samples) {
  std::size_t kinds = 0;
  samples.for_each([&](const auto& of_kind) { kinds += of_kind.empty() ? 0 : 1; });
  if (kinds > 1) {
    samples.for_each(
        [](auto& of_kind) { std::stable_sort(of_kind.begin(), of_kind.end(), kEarlier); });
  }
}

}  // namespace

SampleBatch WritingOrder::pass_on(SampleBatch taken, Instant now) {
  SampleBatch out;
  out.rejected = std::move(taken.rejected);
  bool first_heard = false;
  taken.samples.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      first_heard |= is_new(sample.origin);
    }
  });
  if (first_heard && !until_) {
    until_ = now + kLastMinutes;
  }
  if (until_ && now < *until_ && count_of(held_.samples) + count_of(taken.samples) < kMost) {
    TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
      move_all(taken.samples.of<Value>(), held_.samples.of<Value>());
    });
    return out;
  }
  until_.reset();
  out.samples = std::exchange(held_.samples, std::move(taken.samples));
  const BatchPlace last = last_written(out.samples);
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    auto& newer = held_.samples.of<Value>();
    const auto older = std::stable_partition(
        newer.begin(), newer.end(), [last](const auto& sample) { return sample.place > last; });
    std::move(older, newer.end(), std::back_inserter(out.samples.of<Value>()));
    newer.erase(older, newer.end());
  });
  sort_if_of_several_kinds(out.samples);
  return out;
}

SampleBatch WritingOrder::rest() {
  sort_if_of_several_kinds(held_.samples);
  return std::exchange(held_, {});
}

bool WritingOrder::is_new(const Origin& origin) {
  if (last_ && last_->second == origin.session && last_->first == origin.source) {
    return false;
  }
  last_ = {origin.source, origin.session};
  if (heard_.size() >= kMostSessions && !heard_.contains(*last_)) {
    heard_.clear();
  }
  return heard_.insert(*last_).second;
}

}  // namespace spindrift
