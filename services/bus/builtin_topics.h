/// @file
/// Lists participants and endpoints on the bus by DDS's built-in topics.

#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <string>
#include <vector>

#include "services/bus/entity.h"
#include "services/bus/loan.h"

namespace spindrift::bus {

/// Returns the partitions of a publisher, a subscriber or an endpoint: at least one, "" by default.
std::vector<std::string> partitions_of(const dds_qos_t* qos);

/// Returns "unknown" when the property is missing.
std::string property(const dds_qos_t* qos, const char* name);

/// Calls `handler(const Sample&)` for each participant or endpoint in a built-in topic.
/// @param entity Any entity of the domain. @return Unavailable when Cyclone refuses.
template <class Sample, class Handler>
Expected<void> for_each_present(dds_entity_t entity, dds_entity_t builtin_topic,
                                const Handler& handler) {
  const auto reader =
      Entity::own(dds_create_reader(dds_get_participant(entity), builtin_topic, nullptr, nullptr),
                  "DDS reader of a built-in topic");
  if (!reader) {
    return Unexpected{reader.error()};
  }
  while (true) {
    const Loan loan{*reader};
    if (!loan.count()) {
      return Unexpected{loan.count().error()};
    }
    if (*loan.count() == 0) {
      return {};
    }
    for (std::size_t i = 0; i < *loan.count(); ++i) {
      if (loan[i] != nullptr) {
        handler(*static_cast<const Sample*>(loan[i]));
      }
    }
  }
}

}  // namespace spindrift::bus
