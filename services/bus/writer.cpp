#include "services/bus/writer.h"

#include <fmt/format.h>

#include "services/bus/endpoints.h"

namespace spindrift::bus {

Expected<UntypedWriter> UntypedWriter::create(const Participant& participant, const char* topic,
                                              const dds_topic_descriptor_t* type, const Qos& qos,
                                              Sending sending) {
  const auto created_topic =
      Entity::own(dds_create_topic(participant.handle(), type, topic, nullptr, nullptr),
                  fmt::format("DDS topic {}", topic));
  if (!created_topic) {
    return Unexpected{created_topic.error()};
  }
  // Cyclone has this setting per process only; it applies to writers created while it is set.
  dds_write_set_batch(sending == Sending::Packed);
  auto writer = Entity::own(
      dds_create_writer(participant.publisher(), created_topic->handle(), qos.get(), nullptr),
      fmt::format("DDS writer of {}", topic));
  dds_write_set_batch(false);
  if (!writer) {
    return Unexpected{writer.error()};
  }
  return UntypedWriter{std::move(*writer), topic};
}

Error UntypedWriter::error(std::string_view what, dds_return_t result) const {
  return dds_error(fmt::format("{} {}", what, topic_), result);
}

Expected<void> UntypedWriter::write(const void* sample) const {
  const dds_return_t result = dds_write(writer_.handle(), sample);
  if (result < 0) {
    return Unexpected{error("writing to", result)};
  }
  return {};
}

Expected<void> UntypedWriter::write(const void* sample, const std::stop_token& stop) const {
  dds_return_t result = DDS_RETCODE_TIMEOUT;
  while (result == DDS_RETCODE_TIMEOUT && !stop.stop_requested()) {
    result = dds_write(writer_.handle(), sample);
  }
  if (result < 0) {
    return Unexpected{error("writing to", result)};
  }
  return {};
}

Expected<void> UntypedWriter::wait_for_reader(std::chrono::nanoseconds timeout) const {
  const dds_time_t deadline_ns = dds_time() + timeout.count();
  dds_publication_matched_status_t matched{};
  while (true) {
    const dds_return_t result = dds_get_publication_matched_status(writer_.handle(), &matched);
    if (result < 0) {
      return Unexpected{error("status of the writer of", result)};
    }
    if (matched.current_count > 0) {
      return {};
    }
    if (dds_time() >= deadline_ns) {
      return Unexpected{error("waiting for a reader of", DDS_RETCODE_TIMEOUT)};
    }
    dds_sleepfor(DDS_MSECS(10));
  }
}

void UntypedWriter::flush() const { dds_write_flush(writer_.handle()); }

Expected<void> UntypedWriter::wait_for_acknowledgments(std::chrono::nanoseconds timeout) const {
  flush();
  const dds_return_t result = dds_wait_for_acks(writer_.handle(), timeout.count());
  if (result < 0) {
    return Unexpected{error("waiting for the acknowledgment of samples on", result)};
  }
  return {};
}

Expected<WriterStatus> UntypedWriter::status() const {
  dds_publication_matched_status_t matched{};
  dds_offered_incompatible_qos_status_t incompatible{};
  for (const dds_return_t result :
       {dds_get_publication_matched_status(writer_.handle(), &matched),
        dds_get_offered_incompatible_qos_status(writer_.handle(), &incompatible)}) {
    if (result < 0) {
      return Unexpected{error("status of the writer of", result)};
    }
  }
  WriterStatus status{.readers = matched.current_count, .incompatible_readers = {}};
  if (incompatible.total_count > 0) {
    auto readers = incompatible_readers(writer_);
    if (!readers) {
      return Unexpected{readers.error()};
    }
    status.incompatible_readers = std::move(*readers);
  }
  return status;
}

}  // namespace spindrift::bus
