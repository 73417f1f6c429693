/// @file
/// Membership of this process in one domain and one partition of the bus.

#pragma once

#include <cstdint>
#include <string>

#include "services/bus/domain.h"
#include "services/bus/entity.h"

namespace spindrift::bus {

struct BusConfig {
  std::uint32_t domain = 0;
  std::string partition = "live";  ///< Endpoints match only within the same partition.
};

/// A participant, which must outlive the readers, writers and waitsets created on it.
class Participant {
 public:
  /// @return the errors of Domain::join; Unavailable when Cyclone refuses.
  static Expected<Participant> create(const BusConfig& config);

  /// Returns domain, partition and the network configuration in force, for the log.
  const std::string& description() const { return description_; }

  /// While deaf, Cyclone drops everything from other processes in the whole domain without
  /// acknowledging it; reliable samples are sent again afterwards.
  void set_deaf(bool deaf) const;

  dds_entity_t handle() const { return participant_.handle(); }
  dds_entity_t publisher() const { return publisher_.handle(); }
  dds_entity_t subscriber() const { return subscriber_.handle(); }

 private:
  Participant(Domain domain, Entity participant, Entity publisher, Entity subscriber,
              std::string description)
      : domain_{std::move(domain)},
        participant_{std::move(participant)},
        publisher_{std::move(publisher)},
        subscriber_{std::move(subscriber)},
        description_{std::move(description)} {}

  // Declared in this order, so that the domain is destroyed last.
  Domain domain_;
  Entity participant_;
  Entity publisher_;
  Entity subscriber_;
  std::string description_;
};

}  // namespace spindrift::bus
