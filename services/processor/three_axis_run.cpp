#include "services/processor/three_axis_run.h"

#include <iterator>
#include <utility>
#include <variant>

#include "services/clock/wall_clock.h"

namespace spindrift {

ThreeAxisRun::ThreeAxisRun(const Mission& mission, const std::string& run_id)
    : config_{std::get<ThreeAxisConfig>(mission.config)},
      orbit_{mission.orbit},
      computing_{mission.spacecraft_id, run_id, ThreeAxisPass{config_, orbit_}} {
  begin(run_id);
}

void ThreeAxisRun::begin(const std::string& run_id) {
  computing_.begin(run_id, ThreeAxisPass{config_, orbit_});
  summary_ = {};
  summary_.run_id = run_id;
  summary_.spacecraft_id = computing_.spacecraft_id();
  summary_.kind = SpacecraftKind::ThreeAxis;
}

void ThreeAxisRun::go_on(const std::string& first, AllMadeBefore made) {
  computing_.go_on(std::move(made));
  begin(first);
}

std::vector<ArchiveBatch> ThreeAxisRun::compute(const PassInput& input) {
  std::vector<ArchiveBatch> batches;
  if (input.run_id != computing_.run_id()) {
    batches.push_back(finish());
    finished_.push_back(summary());
    begin(input.run_id);
  }
  auto computed =
      computing_.compute(input, [this](const ThreeAxisOutput& output) { note(output); });
  std::move(computed.begin(), computed.end(), std::back_inserter(batches));
  return batches;
}

ArchiveBatch ThreeAxisRun::finish() {
  ArchiveBatch last = computing_.batch();
  computing_.finish(last.products, [this](const ThreeAxisOutput& output) { note(output); });
  last.finished_utc = utc_now();
  return last;
}

std::vector<RunSummary> ThreeAxisRun::summaries() const {
  std::vector<RunSummary> summaries = finished_;
  summaries.push_back(summary());
  return summaries;
}

RunSummary ThreeAxisRun::summary() const {
  RunSummary summary = summary_;
  summary.sensors = computing_.pass().sensors();
  return summary;
}

void ThreeAxisRun::note(const ThreeAxisOutput& output) {
  for (const ThreeAxisProduct& product : output.products) {
    summary_.count(product);
  }
}

}  // namespace spindrift
