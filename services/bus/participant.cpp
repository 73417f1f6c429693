#include "services/bus/participant.h"

#include <fmt/format.h>

#include "services/bus/network.h"
#include "services/bus/qos.h"

namespace spindrift::bus {

Expected<Participant> Participant::create(const BusConfig& config) {
  auto domain = Domain::join(config.domain);
  if (!domain) {
    return Unexpected{domain.error()};
  }
  auto participant = Entity::own(dds_create_participant(config.domain, nullptr, nullptr),
                                 fmt::format("DDS participant in domain {}", config.domain));
  if (!participant) {
    return Unexpected{participant.error()};
  }
  const Qos partition = partition_qos(config.partition);
  auto publisher =
      Entity::own(dds_create_publisher(participant->handle(), partition.get(), nullptr),
                  fmt::format("DDS publisher in partition '{}'", config.partition));
  if (!publisher) {
    return Unexpected{publisher.error()};
  }
  auto subscriber =
      Entity::own(dds_create_subscriber(participant->handle(), partition.get(), nullptr),
                  fmt::format("DDS subscriber in partition '{}'", config.partition));
  if (!subscriber) {
    return Unexpected{subscriber.error()};
  }
  return Participant{std::move(*domain), std::move(*participant), std::move(*publisher),
                     std::move(*subscriber),
                     fmt::format("domain {}, partition '{}', network {}", config.domain,
                                 config.partition, network_configuration().name)};
}

void Participant::set_deaf(bool deaf) const {
  // Fails only for a handle that is not in a domain.
  static_cast<void>(dds_domain_set_deafmute(participant_.handle(), deaf, false, DDS_INFINITY));
}

}  // namespace spindrift::bus
