/// @file
/// The computing side of a three-axis spacecraft's run. Its samples are stored; no attitude is
/// computed from them yet.

#pragma once

#include <string>
#include <vector>

#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/pass_input.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Called as PassRun is.
class ThreeAxisRun {
 public:
  ThreeAxisRun(const Mission& mission, const std::string& run_id);

  void go_on(const std::string& run_id);
  std::vector<ArchiveBatch> compute(const PassInput& input);
  ArchiveBatch finish() const;
  std::vector<RunSummary> summaries() const { return summaries_; }

 private:
  void begin(const std::string& run_id);

  std::string spacecraft_id_;
  std::vector<RunSummary> summaries_;  ///< The last is that of the run that goes on.
};

}  // namespace spindrift
