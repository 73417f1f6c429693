#include "services/publisher/telemetry_publisher.h"

#include <random>

namespace spindrift {

std::uint64_t random_session() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>{}(device);
}

}  // namespace spindrift
