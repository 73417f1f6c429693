/// @file
/// A typed writer that feels the pressure of its readers.

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
  std::uint32_t readers;                          ///< Matched now.
  std::vector<std::string> incompatible_readers;  ///< In sight now; see endpoints.h.
};

enum class Sending {
  AtOnce,  ///< Every sample goes out by itself.
  Packed,  ///< When a packet is full, or on flush: cheaper by far for all, when many come in a row.
};

/// Everything about a writer that does not depend on the type of its samples.
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

  /// One attempt. @return Unavailable when readers hold it up for longer than the QoS allows, or
  /// Cyclone refuses the sample.
  Expected<void> write(const Sample& sample) const { return writer_.write(&sample); }

  /// Waits for as long as readers push back. A reader of this process may then see the sample
  /// twice. @return Unavailable when stopped meanwhile, or Cyclone refuses the sample.
  Expected<void> write(const Sample& sample, const std::stop_token& stop) const {
    return writer_.write(&sample, stop);
  }

  /// Until at least one reader is matched. @return Unavailable after `timeout`.
  Expected<void> wait_for_reader(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_reader(timeout);
  }

  /// What is still packed goes out.
  void flush() const { writer_.flush(); }

  /// Until all matched readers have everything, what is still packed too. @return Unavailable after
  /// `timeout`.
  Expected<void> wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
    return writer_.wait_for_acknowledgments(timeout);
  }

  /// From any thread. @return Unavailable when Cyclone refuses.
  Expected<WriterStatus> status() const { return writer_.status(); }

 private:
  explicit Writer(UntypedWriter&& writer) : writer_{std::move(writer)} {}

  UntypedWriter writer_;
};

}  // namespace spindrift::bus
