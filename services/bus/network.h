/// @file
/// Which network Cyclone DDS may use. The program decides, not the defaults of the library.

#pragma once

#include <string>

namespace spindrift::bus {

struct NetworkConfiguration {
  std::string text;  ///< As Cyclone takes it: XML, or a list of file URIs and XML.
  std::string name;  ///< Where it came from, for the log.
};

/// CYCLONEDDS_URI when that is set and not empty, else the built-in deploy/cyclonedds/loopback.xml:
/// this host only.
NetworkConfiguration network_configuration();

}  // namespace spindrift::bus
