#include "services/publisher/pulse_publisher.h"

#include <random>
#include <utility>

#include "services/publisher/to_idl.h"

namespace spindrift {
namespace {

std::uint64_t random_session() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>{}(device);
}

}  // namespace

Expected<PulsePublisher> PulsePublisher::create(const bus::Participant& participant,
                                                std::string source) {
  return bus::Writer<spindrift_Pulse>::create(participant, bus::kPulseTopic,
                                              bus::telemetry_writer_qos())
      .map([&source](bus::Writer<spindrift_Pulse>&& writer) {
        return PulsePublisher{std::move(writer),
                              {.source = std::move(source), .session = random_session(), .seq = 0}};
      });
}

Expected<void> PulsePublisher::publish(std::string_view spacecraft, const Pulse& pulse,
                                       const std::stop_token& stop) {
  return to_idl({.spacecraft = std::string{spacecraft}, .origin = next_, .pulse = pulse})
      .and_then([&](const spindrift_Pulse& sample) { return writer_.write(sample, stop); })
      .map([this] { ++next_.seq; });
}

Expected<void> PulsePublisher::wait_for_subscriber(std::chrono::nanoseconds timeout) const {
  return writer_.wait_for_reader(timeout);
}

Expected<void> PulsePublisher::wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
  return writer_.wait_for_acknowledgments(timeout);
}

}  // namespace spindrift
