/// @file
/// Compares the QoS policies of a writer with those that a reader needs.

#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

namespace spindrift::bus {

/// A policy as offered and as needed, such as "BEST_EFFORT" where "RELIABLE" is needed.
struct Shortfall {
  std::string offered;
  std::string needed;
};

/// Applies the DDS rules for offered and requested QoS; returns empty when the policies match.
std::vector<Shortfall> shortfalls(const dds_qos_t* offered, const dds_qos_t* needed);

}  // namespace spindrift::bus
