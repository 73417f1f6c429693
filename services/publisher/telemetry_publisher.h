/// @file
/// Recorded or simulated telemetry out on the bus, as a front-end would send it.

#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>

#include "services/bus/writer.h"
#include "services/ingest/sample.h"

namespace spindrift {

/// Of a source that starts: drawn at random.
std::uint64_t random_session();

/// One topic of one source. `Value`: what is published; `Sample`: the same with its origin;
/// `OnBus`: its generated type.
template <class Value, class Sample, class OnBus>
class TelemetryPublisher {
 public:
  /// @param session  The same for all topics of a source. `participant` outlives the publisher.
  /// @param sending  Packed: whoever has nothing more to publish for a while calls `flush`.
  /// @return Unavailable when Cyclone refuses.
  static Expected<TelemetryPublisher> create(const bus::Participant& participant,
                                             const std::string& source,
                                             std::uint64_t session = random_session(),
                                             bus::Sending sending = bus::Sending::AtOnce);

  /// With the next seq: 0, 1, 2, ... Waits for as long as a subscriber pushes back.
  /// @return InvalidInput for a name that does not fit (to_idl.h), Unavailable when stopped
  ///         meanwhile or the bus refuses; the seq is then not used up.
  Expected<void> publish(std::string_view spacecraft, const Value& value,
                         const std::stop_token& stop);

  /// What is still packed goes out.
  void flush() const { writer_.flush(); }

  /// Until somebody subscribes. @return Unavailable after `timeout`.
  Expected<void> wait_for_subscriber(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_reader(timeout);
  }

  /// Until all subscribers have everything. @return Unavailable after `timeout`.
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_acknowledgments(timeout);
  }

  /// Of the sample to come.
  const Origin& next() const { return next_; }

 private:
  TelemetryPublisher(bus::Writer<OnBus> writer, Origin first)
      : writer_{std::move(writer)}, next_{std::move(first)} {}

  bus::Writer<OnBus> writer_;
  Origin next_;
};

using PulsePublisher = TelemetryPublisher<Pulse, PulseSample, spindrift_Pulse>;
using CodedPublisher = TelemetryPublisher<CodedFrame, CodedSample, spindrift_CodedFrame>;

extern template class TelemetryPublisher<Pulse, PulseSample, spindrift_Pulse>;
extern template class TelemetryPublisher<CodedFrame, CodedSample, spindrift_CodedFrame>;

}  // namespace spindrift
