#include "services/spindrift/batch.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "pipelines/spin/batch/batch_estimator.h"
#include "services/archive/stored_edges.h"
#include "services/mission/mission.h"
#include "services/spindrift/batch_text.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/summary_text.h"

namespace spindrift {

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
  if (options.last_revolutions) {
    stored->pass.keep_last(*options.last_revolutions);
  }
  const auto starts = stored->pass.starts(mission->spin()->prior);
  return solve_batch(*mission->spin(), *mission->orbit, std::move(stored->pass).edges(), starts)
      .map([&](const BatchSolution& solution) {
        if (options.json) {
          nlohmann::json object = to_json(solution.estimate);
          object.update(to_json(solution));
          object["run_id"] = stored->run_id;
          fmt::print("{}\n", object.dump());
        } else {
          fmt::print("{}  run {}\n{}\n{}", mission->spacecraft_id, stored->run_id,
                     to_text(solution.estimate), to_text(solution));
        }
      });
}

}  // namespace spindrift
