/// @file
/// The computing side of a three-axis spacecraft's run: samples in, products for the archive out.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipelines/three_axis/three_axis_pass.h"
#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/pass_computing.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Called as SpinRun is. It hands out no background tasks.
class ThreeAxisRun {
 public:
  ThreeAxisRun(const Mission& mission, const std::string& run_id);

  void go_on(const std::string& first, AllMadeBefore made);
  std::vector<ArchiveBatch> compute(const PassInput& input);
  ArchiveBatch finish();
  std::vector<RunSummary> summaries() const;

 private:
  void begin(const std::string& run_id);
  RunSummary summary() const;
  void note(const ThreeAxisOutput& output);

  ThreeAxisConfig config_;
  std::optional<Orbit> orbit_;
  std::vector<RunSummary> finished_;
  RunSummary summary_;
  PassComputing<ThreeAxisPass> computing_;
};

}  // namespace spindrift
