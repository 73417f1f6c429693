#include "services/ingest/arrivals.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

Arrivals::Arrivals(std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored)
    : ours_{std::move(spacecraft)} {
  for (const std::string& one : ours_) {
    by_spacecraft_.emplace(one, SpacecraftCounts{});
  }
  for (std::size_t kind = 0; kind < stored.size(); ++kind) {
    for (const Origin& last : stored.at(kind)) {
      tracker_.go_on(last, kind);
    }
  }
}

std::map<std::string, SequenceCounts> Arrivals::count(const TelemetrySamples& samples) {
  const std::lock_guard lock{mutex_};
  samples.for_each([this]<class Value>(const SamplesOfKind<Value>& of_kind) {
    for (const TelemetrySample<Value>& sample : of_kind) {
      tracker_.record(sample.origin, sample.spacecraft, kTelemetryKind<Value>);
      ++by_spacecraft_[sample.spacecraft].received;
    }
  });
  return tracker_.take_changed();
}

SampleBatch Arrivals::take_rest(TaiTime now) {
  const std::lock_guard lock{mutex_};
  std::vector<RejectedInput> only_counted = limit_.take_rest(now);
  std::move(only_counted.begin(), only_counted.end(), std::back_inserter(rest_.rejected));
  rest_.counts = tracker_.take_changed();
  return std::exchange(rest_, {});
}

std::map<std::string, SequenceCounts> Arrivals::by_source() const {
  const std::lock_guard lock{mutex_};
  return tracker_.by_source();
}

CountsBySpacecraft Arrivals::by_spacecraft() const {
  const std::lock_guard lock{mutex_};
  return by_spacecraft_;
}

}  // namespace spindrift
