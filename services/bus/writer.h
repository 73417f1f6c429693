/// @file
/// A typed writer, which its readers can block when they are full.

#pragma once

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "services/bus/participant.h"
#include "services/bus/qos.h"
#include "services/bus/topics.h"

namespace spindrift::bus {

struct WriterStatus {
  std::uint32_t readers;                          ///< Number matched now.
  std::vector<std::string> incompatible_readers;  ///< Currently visible; see endpoints.h.
};

enum class Sending {
  AtOnce,  ///< Sends every sample in a packet of its own.
  Packed,  ///< Sends when a packet is full or on flush, which is cheaper for bursts.
};

/// The part of a writer that does not depend on the type of its samples.
class UntypedWriter {
 public:
  static Expected<UntypedWriter> create(const Participant& participant, const char* topic,
                                        const dds_topic_descriptor_t* type, const Qos& qos,
                                        Sending sending);

  Expected<void> write(const void* sample) const;
  Expected<void> write(const void* sample, const std::stop_token& stop) const;
  Expected<void> wait_for_reader(std::chrono::nanoseconds timeout) const;
  void flush() const;
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const;
  Expected<WriterStatus> status() const;

 private:
  UntypedWriter(Entity writer, std::string topic)
      : writer_{std::move(writer)}, topic_{std::move(topic)} {}

  Error error(std::string_view what, dds_return_t result) const;

  Entity writer_;
  std::string topic_;
};

template <class Sample>
class Writer {
 public:
  /// @return Unavailable, naming the topic, when Cyclone refuses.
  static Expected<Writer> create(const Participant& participant, const Topic<Sample>& topic,
                                 const Qos& qos, Sending sending = Sending::AtOnce) {
    return UntypedWriter::create(participant, topic.name, topic.type, qos, sending)
        .map([](UntypedWriter&& writer) { return Writer{std::move(writer)}; });
  }

  /// Tries once. @return Unavailable when readers block it for longer than the QoS allows, or
  /// Cyclone refuses the sample.
  Expected<void> write(const Sample& sample) const { return writer_.write(&sample); }

  /// Waits while readers block it. A reader in this process may then receive the sample twice.
  /// @return Unavailable when stopped meanwhile, or Cyclone refuses the sample.
  Expected<void> write(const Sample& sample, const std::stop_token& stop) const {
    return writer_.write(&sample, stop);
  }

  /// Waits until at least one reader is matched. @return Unavailable after `timeout`.
  Expected<void> wait_for_reader(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_reader(timeout);
  }

  /// Sends the samples that are still packed.
  void flush() const { writer_.flush(); }

  /// Waits until all matched readers have everything, including packed samples.
  /// @return Unavailable after `timeout`.
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_acknowledgments(timeout);
  }

  /// Safe to call from any thread. @return Unavailable when Cyclone refuses.
  Expected<WriterStatus> status() const { return writer_.status(); }

 private:
  explicit Writer(UntypedWriter&& writer) : writer_{std::move(writer)} {}

  UntypedWriter writer_;
};

}  // namespace spindrift::bus
