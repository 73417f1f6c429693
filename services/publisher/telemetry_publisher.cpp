#include "services/publisher/telemetry_publisher.h"

#include <random>
#include <type_traits>
#include <utility>

#include "services/publisher/to_idl.h"

namespace spindrift {
namespace {

template <class OnBus>
const bus::Topic<OnBus>& topic_of() {
  if constexpr (std::is_same_v<OnBus, spindrift_Pulse>) {
    return bus::kPulseTopic;
  } else {
    return bus::kCodedFrameTopic;
  }
}

}  // namespace

std::uint64_t random_session() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>{}(device);
}

template <class Value, class Sample, class OnBus>
Expected<TelemetryPublisher<Value, Sample, OnBus>> TelemetryPublisher<Value, Sample, OnBus>::create(
    const bus::Participant& participant, const std::string& source, std::uint64_t session,
    bus::Sending sending) {
  return bus::Writer<OnBus>::create(participant, topic_of<OnBus>(), bus::telemetry_writer_qos(),
                                    sending)
      .map([&](bus::Writer<OnBus>&& writer) {
        return TelemetryPublisher{std::move(writer),
                                  {.source = source, .session = session, .seq = 0}};
      });
}

template <class Value, class Sample, class OnBus>
Expected<void> TelemetryPublisher<Value, Sample, OnBus>::publish(std::string_view spacecraft,
                                                                 const Value& value,
                                                                 const std::stop_token& stop) {
  return to_idl(Sample{std::string{spacecraft}, next_, value})
      .and_then([&](const OnBus& sample) { return writer_.write(sample, stop); })
      .map([this] { ++next_.seq; });
}

template class TelemetryPublisher<Pulse, PulseSample, spindrift_Pulse>;
template class TelemetryPublisher<CodedFrame, CodedSample, spindrift_CodedFrame>;

}  // namespace spindrift
