/// @file
/// Which policies of a writer offer less than a reader needs.

#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

namespace spindrift::bus {

/// One policy, in words: "BEST_EFFORT" where "RELIABLE" is needed.
struct Shortfall {
  std::string offered;
  std::string needed;
};

/// The rules of DDS for offered and requested QoS. Empty: by these policies they match.
std::vector<Shortfall> shortfalls(const dds_qos_t* offered, const dds_qos_t* needed);

}  // namespace spindrift::bus
