#include "services/processor/three_axis_run.h"

#include "services/clock/wall_clock.h"

namespace spindrift {

ThreeAxisRun::ThreeAxisRun(const Mission& mission, const std::string& run_id)
    : spacecraft_id_{mission.spacecraft_id} {
  begin(run_id);
}

void ThreeAxisRun::begin(const std::string& run_id) {
  RunSummary fresh;
  fresh.run_id = run_id;
  fresh.spacecraft_id = spacecraft_id_;
  fresh.kind = SpacecraftKind::ThreeAxis;
  summaries_.push_back(std::move(fresh));
}

void ThreeAxisRun::go_on(const std::string& run_id) {
  summaries_.pop_back();
  begin(run_id);
}

std::vector<ArchiveBatch> ThreeAxisRun::compute(const PassInput& input) {
  if (input.run_id == summaries_.back().run_id) {
    return {};
  }
  std::vector<ArchiveBatch> ended{finish()};
  begin(input.run_id);
  return ended;
}

ArchiveBatch ThreeAxisRun::finish() const {
  ArchiveBatch last;
  last.run_id = summaries_.back().run_id;
  last.spacecraft_id = spacecraft_id_;
  last.finished_utc = utc_now();
  return last;
}

}  // namespace spindrift
