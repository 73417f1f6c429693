/// @file
/// A subscriber to one topic, on the bus of a service under test.

#pragma once

#include "services/bus/participant.h"
#include "services/bus/qos.h"
#include "services/bus/reader.h"

namespace spindrift {

template <class Message>
class Subscriber {
 public:
  /// @param qos The usual one keeps the latest message of each key.
  Subscriber(const bus::BusConfig& bus, const bus::Topic<Message>& topic,
             const bus::Qos& qos = bus::results_qos())
      : participant_{bus::Participant::create(bus).value()},
        reader_{bus::Reader<Message>::create(participant_, topic, qos).value()} {}

  const bus::Reader<Message>& reader() const { return reader_; }
  /// Calls `see` with each new message.
  /// @return Number of messages.
  template <class See>
  auto take(const See& see) const {
    return reader_.take(see).value();
  }

 private:
  bus::Participant participant_;
  bus::Reader<Message> reader_;
};

}  // namespace spindrift
