#include "services/ingest/rehearsal_clocks.h"

#include <cstddef>

#include "services/bus/qos.h"
#include "services/bus/topics.h"

namespace spindrift {
namespace {

// Limit of spacecraft whose clocks are kept, to bound memory.
constexpr std::size_t kMostSpacecraft = 4096;

}  // namespace

Expected<RehearsalClocks> RehearsalClocks::create(const bus::Participant& participant) {
  return bus::Reader<spindrift_RehearsalClock>::create(participant, bus::kRehearsalClockTopic,
                                                       bus::results_qos())
      .map([](bus::Reader<spindrift_RehearsalClock>&& reader) {
        return RehearsalClocks{std::move(reader)};
      });
}

Expected<void> RehearsalClocks::look() {
  const std::lock_guard lock{*mutex_};
  const auto note = [&](const spindrift_RehearsalClock& clock) {
    if (offsets_.size() < kMostSpacecraft || offsets_.contains(clock.spacecraft)) {
      offsets_.insert_or_assign(clock.spacecraft, std::chrono::nanoseconds{clock.offset_ns});
    }
  };
  return reader_.take(note).map([](std::size_t /*taken*/) {});
}

std::optional<std::chrono::nanoseconds> RehearsalClocks::offset(
    const std::string& spacecraft) const {
  const std::lock_guard lock{*mutex_};
  const auto known = offsets_.find(spacecraft);
  return known == offsets_.end() ? std::nullopt : std::optional{known->second};
}

RehearsalClocks::Offsets RehearsalClocks::offsets() const {
  const std::lock_guard lock{*mutex_};
  return offsets_;
}

}  // namespace spindrift
