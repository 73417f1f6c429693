/// @file
/// By which clock the telemetry of a rehearsal goes.

#pragma once

#include <spindrift.h>

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "services/bus/reader.h"

namespace spindrift {

/// As `replay --now` and `simulate --publish --now` tell it.
class RehearsalClocks {
 public:
  /// `participant` outlives it. @return Unavailable when Cyclone refuses.
  static Expected<RehearsalClocks> create(const bus::Participant& participant);

  /// What has come since. @return Unavailable when Cyclone refuses.
  Expected<void> look();

  /// How far the host's clock is ahead of the telemetry that is due. Empty: no rehearsal told it.
  std::optional<std::chrono::nanoseconds> offset(const std::string& spacecraft) const;

 private:
  explicit RehearsalClocks(bus::Reader<spindrift_RehearsalClock> reader)
      : reader_{std::move(reader)} {}

  bus::Reader<spindrift_RehearsalClock> reader_;
  std::map<std::string, std::chrono::nanoseconds> offsets_;
};

}  // namespace spindrift
