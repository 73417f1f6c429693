#include "services/spindrift/orbit_notice.h"

#include <spdlog/spdlog.h>

#include "pipelines/core/shown.h"

namespace spindrift {

void warn_of_orbit(const std::filesystem::path& file, const Mission& mission) {
  for (const std::string& doubt : mission.orbit_doubts) {
    spdlog::warn("{}: {}", shown(file.string()), doubt);
  }
}

}  // namespace spindrift
