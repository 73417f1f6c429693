/// @file
/// Who else is on the bus, and whether those who should meet do.

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

/// A reader or a writer of somebody else on a topic of spindrift.
struct Endpoint {
  bool writes;
  std::string topic;
  std::vector<std::string> partitions;  ///< DDS takes each as a pattern; never empty.
  std::string owner;
  std::vector<bus::Shortfall> shortfalls;  ///< Against the QoS of spindrift for the other side.
};

struct PresenceFacts {
  bus::BusConfig bus;                     ///< Domain and partition asked about.
  std::vector<std::string> participants;  ///< Process and host of each, but ours.
  std::vector<Endpoint> endpoints;
};

/// Listens for a second. Makes no reader or writer of its own on a topic of spindrift: a front-end
/// must not take the doctor for the service.
/// @param partner A process of ours, not to be counted.
/// @return Unavailable when Cyclone refuses.
Expected<PresenceFacts> presence_facts(const bus::BusConfig& bus, pid_t partner);

std::vector<Check> check_presence(const PresenceFacts& facts);

}  // namespace spindrift::doctor
