#include "services/bus/network.h"

#include <cstdlib>

namespace spindrift {
namespace embedded {
extern const char* const kLoopbackXml;
}  // namespace embedded

namespace bus {

NetworkConfiguration network_configuration() {
  // Nothing in spindrift changes the environment, so that reading it is safe from any thread.
  const char* uri = std::getenv("CYCLONEDDS_URI");  // NOLINT(concurrency-mt-unsafe)
  if (uri != nullptr && *uri != '\0') {
    return {.text = uri, .name = std::string{"CYCLONEDDS_URI="} + uri};
  }
  return {.text = embedded::kLoopbackXml, .name = "built-in loopback.xml (this host only)"};
}

}  // namespace bus
}  // namespace spindrift
