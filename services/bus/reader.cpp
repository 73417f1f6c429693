#include "services/bus/reader.h"

#include <fmt/format.h>

#include <functional>
#include <new>

#include "services/bus/endpoints.h"

namespace spindrift::bus {

ReaderStatus& ReaderStatus::operator+=(const ReaderStatus& other) {
  writers += other.writers;
  lost += other.lost;
  rejected += other.rejected;
  incompatible_writers.insert(incompatible_writers.end(), other.incompatible_writers.begin(),
                              other.incompatible_writers.end());
  return *this;
}

namespace {

/// Called by Cyclone, so no exception may escape. Out of memory it keeps the sample.
bool accepts_or_leaves(const void* sample, void* filter) {
  try {
    return (*static_cast<std::function<bool(const void*)>*>(filter))(sample);
  } catch (const std::bad_alloc& /*exception*/) {
    return true;
  }
}

}  // namespace

Expected<UntypedReader> UntypedReader::create(const Participant& participant, const char* topic,
                                              const dds_topic_descriptor_t* type, const Qos& qos,
                                              Filter accepts) {
  const auto created_topic =
      Entity::own(dds_create_topic(participant.handle(), type, topic, nullptr, nullptr),
                  fmt::format("DDS topic {}", topic));
  if (!created_topic) {
    return Unexpected{created_topic.error()};
  }
  auto filter = accepts ? std::make_unique<Filter>(std::move(accepts)) : nullptr;
  if (filter) {
    const dds_topic_filter by_sample{.mode = DDS_TOPIC_FILTER_SAMPLE_ARG,
                                     .f = {.sample_arg = accepts_or_leaves},
                                     .arg = filter.get()};
    const dds_return_t result = dds_set_topic_filter_extended(created_topic->handle(), &by_sample);
    if (result < 0) {
      return Unexpected{dds_error(fmt::format("filter of DDS topic {}", topic), result)};
    }
  }
  auto reader = Entity::own(
      dds_create_reader(participant.subscriber(), created_topic->handle(), qos.get(), nullptr),
      fmt::format("DDS reader of {}", topic));
  if (!reader) {
    return Unexpected{reader.error()};
  }
  auto data = Entity::own(dds_create_readcondition(reader->handle(), DDS_ANY_STATE),
                          fmt::format("DDS read condition of {}", topic));
  if (!data) {
    return Unexpected{data.error()};
  }
  return UntypedReader{std::move(filter), std::move(*reader), std::move(*data)};
}

Expected<ReaderStatus> UntypedReader::status() const {
  dds_subscription_matched_status_t matched{};
  dds_sample_lost_status_t lost{};
  dds_sample_rejected_status_t rejected{};
  dds_requested_incompatible_qos_status_t incompatible{};
  for (const dds_return_t result :
       {dds_get_subscription_matched_status(reader_.handle(), &matched),
        dds_get_sample_lost_status(reader_.handle(), &lost),
        dds_get_sample_rejected_status(reader_.handle(), &rejected),
        dds_get_requested_incompatible_qos_status(reader_.handle(), &incompatible)}) {
    if (result < 0) {
      return Unexpected{dds_error("status of a DDS reader", result)};
    }
  }
  ReaderStatus status{.writers = matched.current_count,
                      .lost = lost.total_count,
                      .rejected = rejected.total_count,
                      .incompatible_writers = {}};
  if (incompatible.total_count > 0) {
    auto writers = incompatible_writers(reader_);
    if (!writers) {
      return Unexpected{writers.error()};
    }
    status.incompatible_writers = std::move(*writers);
  }
  return status;
}

}  // namespace spindrift::bus
