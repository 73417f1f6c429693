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

WritingOrder::WritingOrder(const LastOrigins& stored) {
  for (std::size_t kind = 0; kind < stored.size(); ++kind) {
    for (const Origin& origin : stored.at(kind)) {
      const std::pair topic{Session{origin.source, origin.session}, kind};
      behind_.insert(topic);
      std::uint64_t& last = stored_.try_emplace(topic, origin.seq).first->second;
      last = std::max(last, origin.seq);
    }
  }
}

SampleBatch WritingOrder::pass_on(SampleBatch taken, Instant now) {
  SampleBatch out;
  out.rejected = std::move(taken.rejected);
  begin_waiting(taken.samples, now);
  if (until_) {
    until_ = is_behind() ? std::min(now + kLastMinutes, longest_) : until_;
    catch_up(taken.samples, out.samples);
  }
  if (until_ && now < *until_ && count_of(held_.samples) + count_of(taken.samples) < kMost) {
    TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
      move_all(taken.samples.of<Value>(), held_.samples.of<Value>());
    });
    return out;
  }
  until_.reset();
  std::erase_if(behind_, [this](const auto& topic) { return heard_.contains(topic.first); });
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    move_all(held_.samples.of<Value>(), out.samples.of<Value>());
  });
  held_.samples = std::move(taken.samples);
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

void WritingOrder::begin_waiting(const TelemetrySamples& taken, Instant now) {
  bool first_heard = false;
  taken.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      first_heard |= is_new(sample.origin);
    }
  });
  if (first_heard && !until_) {
    until_ = now + kLastMinutes;
    longest_ = now + kLongest;
  }
}

/// Moves what is stored already from `taken` to `stored`: it need not wait.
void WritingOrder::catch_up(TelemetrySamples& taken, TelemetrySamples& stored) {
  if (stored_.empty()) {
    return;
  }
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    auto& samples = taken.of<Value>();
    const auto known =
        std::stable_partition(samples.begin(), samples.end(),
                              [this](const auto& sample) { return !this->is_stored(sample); });
    std::move(known, samples.end(), std::back_inserter(stored.of<Value>()));
    samples.erase(known, samples.end());
  });
}

/// Notes, too, that the topic has come again as far as it is stored.
template <class Value>
bool WritingOrder::is_stored(const TelemetrySample<Value>& sample) {
  const std::pair topic{Session{sample.origin.source, sample.origin.session},
                        kTelemetryKind<Value>};
  const auto last = stored_.find(topic);
  if (last != stored_.end() && sample.origin.seq >= last->second) {
    behind_.erase(topic);
  }
  return last != stored_.end() && sample.origin.seq <= last->second;
}

/// Returns whether a session that is heard has topics that have not come again.
bool WritingOrder::is_behind() const {
  return std::any_of(behind_.begin(), behind_.end(),
                     [this](const auto& topic) { return heard_.contains(topic.first); });
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
