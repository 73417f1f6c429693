/// @file
/// Recorded or simulated pulses out on the bus, as a front-end would send them.

#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>

#include "pipelines/spin/pulse.h"
#include "services/bus/writer.h"
#include "services/ingest/sample.h"

namespace spindrift {

/// One source with a session of its own, drawn at random.
class PulsePublisher {
 public:
  /// `participant` outlives it. @return Unavailable when Cyclone refuses.
  static Expected<PulsePublisher> create(const bus::Participant& participant, std::string source);

  /// On spindrift/pulse with the next seq: 0, 1, 2, ... Waits for as long as a subscriber pushes
  /// back. @return InvalidInput for a name that does not fit (to_idl.h), Unavailable when stopped
  /// meanwhile or the bus refuses; the seq is then not used up.
  Expected<void> publish(std::string_view spacecraft, const Pulse& pulse,
                         const std::stop_token& stop);

  /// Until somebody subscribes. @return Unavailable after `timeout`.
  Expected<void> wait_for_subscriber(std::chrono::nanoseconds timeout) const;

  /// Until all subscribers have everything. @return Unavailable after `timeout`.
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const;

  /// Of the sample to come.
  const Origin& next() const { return next_; }

 private:
  PulsePublisher(bus::Writer<spindrift_Pulse> writer, Origin first)
      : writer_{std::move(writer)}, next_{std::move(first)} {}

  bus::Writer<spindrift_Pulse> writer_;
  Origin next_;
};

}  // namespace spindrift
