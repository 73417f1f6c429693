#include "services/program/orbit_notice.h"

#include <fmt/format.h>

#include "pipelines/core/shown.h"
#include "services/base/warning.h"

namespace spindrift {

void warn_of_orbit(const std::filesystem::path& file, const Mission& mission) {
  for (const std::string& doubt : mission.orbit_doubts) {
    warn("orbit_doubt",
         {{"spacecraft", mission.spacecraft_id}, {"file", file.string()}, {"why", doubt}},
         fmt::format("{}: {}", shown(file.string()), doubt));
  }
}

}  // namespace spindrift
