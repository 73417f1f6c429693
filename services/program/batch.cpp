#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "pipelines/spin/batch/batch_estimator.h"
#include "services/archive/stored_edges.h"
#include "services/base/json_line.h"
#include "services/base/warning.h"
#include "services/mission/mission.h"
#include "services/program/batch_text.h"
#include "services/program/commands.h"
#include "services/program/orbit_notice.h"
#include "services/program/summary_text.h"

namespace spindrift {
namespace {

bool is_same_mission(const StoredEdges& stored, const Mission& mission) {
  return stored.config_sha256 == mission.sha256 && stored.orbit_sha256 == mission.orbit_sha256;
}

/// Using another mission is a legitimate use of the command, but the user must be told.
void warn_of_another_mission(const StoredEdges& stored, const Mission& mission) {
  const auto compare = [&](const char* what, const std::string& now, const std::string& then) {
    if (now != then) {
      warn("not_of_this_run",
           {{"spacecraft", mission.spacecraft_id},
            {"file", what},
            {"run_id", stored.run_id},
            {"sha256", now},
            {"sha256_of_run", then}},
           fmt::format("{}: the {} is not that of run {}: sha256 {} here, {} there",
                       mission.spacecraft_id, what, stored.run_id, now, then));
    }
  };
  compare("mission file", mission.sha256, stored.config_sha256);
  compare("orbit file", mission.orbit_sha256.value_or("(none)"),
          stored.orbit_sha256.value_or("(none)"));
}

}  // namespace

Expected<void> batch(const BatchOptions& options) {
  const auto mission = load_spinner(options.mission);
  if (!mission) {
    return Unexpected{mission.error()};
  }
  warn_of_orbit(options.mission, *mission);
  auto stored = read_edges(options.db, mission->spacecraft_id, options.run);
  if (!stored) {
    return Unexpected{stored.error()};
  }
  warn_of_another_mission(*stored, *mission);
  if (options.last_revolutions) {
    stored->pass.keep_last(*options.last_revolutions);
  }
  SpinConfig config = *mission->spin();
  config.prior = stored->told_prior ? stored->told_prior : config.prior;
  const auto starts = stored->pass.starts(config.prior);
  return solve_batch(config, *mission->orbit, std::move(stored->pass).edges(), starts)
      .map([&](const BatchSolution& solution) {
        if (options.json) {
          nlohmann::json object = to_json(solution.estimate);
          object.update(to_json(solution));
          object["run_id"] = stored->run_id;
          object["same_mission"] = is_same_mission(*stored, *mission);
          fmt::print("{}", json_line(with_warnings(object)));
        } else {
          fmt::print("{}  run {}\n{}\n{}", mission->spacecraft_id, stored->run_id,
                     to_text(solution.estimate), to_text(solution));
        }
      });
}

}  // namespace spindrift
