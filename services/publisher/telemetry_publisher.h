/// @file
/// Publishes recorded or simulated telemetry on the bus as a front-end would.

#pragma once

#include <chrono>
#include <cstdint>
#include <random>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include "services/bus/telemetry_messages.h"
#include "services/bus/writer.h"
#include "services/publisher/to_idl.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

inline std::uint64_t random_session() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>{}(device);
}

template <class Value>
class TelemetryPublisher {
 public:
  /// `participant` must outlive the publisher.
  /// @param session Must be the same for all topics of a source.
  /// @param sending When packed, the caller must call `flush` before a pause in publishing.
  /// @return Unavailable when Cyclone refuses.
  static Expected<TelemetryPublisher> create(const bus::Participant& participant,
                                             const std::string& source,
                                             std::uint64_t session = random_session(),
                                             bus::Sending sending = bus::Sending::AtOnce) {
    return Writer::create(participant, bus::topic_of<Value>(), bus::telemetry_writer_qos(), sending)
        .map([&](Writer&& writer) {
          return TelemetryPublisher{std::move(writer),
                                    {.source = source, .session = session, .seq = 0}};
        });
  }

  /// Publishes a sample with the next seq (0, 1, ...). Waits while a subscriber holds it back.
  /// @return InvalidInput for a name that does not fit (to_idl.h), Unavailable when stopped
  /// meanwhile or when the bus refuses; the seq is then used again.
  Expected<void> publish(std::string_view spacecraft, const Value& value,
                         const std::stop_token& stop) {
    return to_idl(TelemetrySample<Value>{
                      .spacecraft = std::string{spacecraft}, .origin = next_, .value = value})
        .and_then(
            [&](const bus::MessageOf<Value>& message) { return writer_.write(message, stop); })
        .map([this] { ++next_.seq; });
  }

  /// Sends samples that are still packed.
  void flush() const { writer_.flush(); }

  /// Waits until a subscriber exists. @return Unavailable after `timeout`.
  Expected<void> wait_for_subscriber(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_reader(timeout);
  }

  /// Waits until all subscribers have acknowledged everything. @return Unavailable after `timeout`.
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_acknowledgments(timeout);
  }

  const Origin& next() const { return next_; }

 private:
  using Writer = bus::Writer<bus::MessageOf<Value>>;

  TelemetryPublisher(Writer writer, Origin first)
      : writer_{std::move(writer)}, next_{std::move(first)} {}

  Writer writer_;
  Origin next_;
};

}  // namespace spindrift
