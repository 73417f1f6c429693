/// @file
/// Receives the clocks that the telemetry of rehearsals follows.

#pragma once

#include <spindrift.h>

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "services/bus/reader.h"

namespace spindrift {

/// Holds the clocks that `replay --now` and `simulate --publish --now` announce. May be used by any
/// thread.
class RehearsalClocks {
 public:
  /// `participant` must outlive this object. @return Unavailable when Cyclone refuses.
  static Expected<RehearsalClocks> create(const bus::Participant& participant);

  /// Reads the announcements that have come since the last call.
  /// @return Unavailable when Cyclone refuses.
  Expected<void> look();

  /// Returns how far the host's clock is ahead of the due telemetry; empty when unknown.
  std::optional<std::chrono::nanoseconds> offset(const std::string& spacecraft) const;
  using Offsets = std::map<std::string, std::chrono::nanoseconds>;
  /// Returns all that are known, by spacecraft.
  Offsets offsets() const;

 private:
  explicit RehearsalClocks(bus::Reader<spindrift_RehearsalClock> reader)
      : reader_{std::move(reader)} {}

  bus::Reader<spindrift_RehearsalClock> reader_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  Offsets offsets_;
};

}  // namespace spindrift
