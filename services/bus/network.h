/// @file
/// The network that Cyclone DDS may use, chosen by the program and not by the library.

#pragma once

#include <string>

namespace spindrift::bus {

struct NetworkConfiguration {
  std::string text;  ///< Cyclone format: XML, or a list of file URIs and XML.
  std::string name;  ///< Source of the configuration, for the log.
};

/// Returns CYCLONEDDS_URI when that is set and not empty, else the built-in
/// deploy/cyclonedds/loopback.xml, which allows this host only.
NetworkConfiguration network_configuration();

}  // namespace spindrift::bus
