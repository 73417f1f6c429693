/// @file
/// Checks who else is on the bus, and whether endpoints that should match do.

#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/bus/participant.h"
#include "services/bus/policies.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

/// A reader or writer of another process on a topic of spindrift.
struct Endpoint {
  bool writes;
  std::string topic;
  std::vector<std::string> partitions;  ///< DDS patterns; never empty.
  std::string owner;
  std::vector<bus::Shortfall> shortfalls;  ///< Compared with spindrift's QoS of the other side.
};

struct PresenceFacts {
  bus::BusConfig bus;                     ///< Domain and partition to check.
  std::vector<std::string> participants;  ///< Process and host of each other participant.
  std::vector<Endpoint> endpoints;
};

/// Listens for a second. It creates no reader or writer on a topic of spindrift, so that no
/// front-end takes the doctor for the service.
/// @param partner Process of ours that is not counted.
/// @return Unavailable when Cyclone refuses.
Expected<PresenceFacts> presence_facts(const bus::BusConfig& bus, pid_t partner);

std::vector<Check> check_presence(const PresenceFacts& facts);

}  // namespace spindrift::doctor
