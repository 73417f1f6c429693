#include "services/program/arrival_tally.h"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace spindrift {
namespace {

void note_at(std::string_view channel, TaiTime t, TalliedArrivals& arrivals) {
  ++arrivals.samples;
  const auto place = arrivals.last.try_emplace(channel, t).first;
  place->second = std::max(place->second, t);
}

template <class Value>
void note_value(const Value& value, TalliedArrivals& arrivals) {
  if constexpr (std::is_same_v<Value, Pulse>) {
    note_at(name_of(value.channel), value.t, arrivals);
  } else if constexpr (std::is_same_v<Value, CodedFrame>) {
    for (const Pulse& edge : edges_of(value)) {
      note_at(name_of(edge.channel), edge.t, arrivals);
    }
  } else if constexpr (!std::is_same_v<Value, TimedOrbitState>) {
    note_at(Telemetry<Value>::kName, value.t, arrivals);
  }
}

/// @param samples ArrivedSamples or TelemetryValues.
template <class Samples>
void note_samples(const Samples& samples, TalliedArrivals& arrivals) {
  samples.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      if (!is_left_out(sample)) {
        note_value(sample.value, arrivals);
      }
    }
  });
}

}  // namespace

void ArrivalTally::count(const ArchiveBatch& batch) {
  const std::lock_guard lock{mutex_};
  TalliedArrivals& arrivals = by_spacecraft_[batch.spacecraft_id];
  if (batch.start || batch.continuation) {
    arrivals = {.run_id = batch.run_id, .samples = arrivals.samples};
  }
  note_samples(batch.samples, arrivals);
  note_samples(batch.moved, arrivals);
  if (batch.run_id != arrivals.run_id) {
    return;  // These are late products of the previous run.
  }
  for (const Product& product : batch.products) {
    // Fixes are stored at once, revolutions a second late.
    if (const auto* const fix = std::get_if<SpinFix>(&product)) {
      arrivals.revolution = std::max(arrivals.revolution, std::optional{fix->revolution});
    } else if (const auto* const turn = std::get_if<RevolutionProduct>(&product)) {
      arrivals.revolution = std::max(arrivals.revolution, std::optional{turn->revolution});
    }
  }
}

TalliedArrivals ArrivalTally::of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto found = by_spacecraft_.find(spacecraft);
  return found == by_spacecraft_.end() ? TalliedArrivals{} : found->second;
}

}  // namespace spindrift
