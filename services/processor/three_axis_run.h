/// @file
/// The computing side of a three-axis spacecraft's run: samples in, products for the archive out.

#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/reconstruction/separation_record.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/background_task.h"
#include "services/processor/pass_computing.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Called as SpinRun is. Where the mission tells of a separation it is reconstructed at the end of
/// the pass, from all that arrived; meanwhile whenever SeparationRecord says: then `batch`
/// first, and `sequential` behind it.
class ThreeAxisRun {
 public:
  ThreeAxisRun(const Mission& mission, const std::string& run_id, SolvingPlan plan);

  void go_on(const std::string& first, AllMadeBefore made);
  std::vector<ArchiveBatch> compute(const PassInput& input);
  std::vector<BackgroundTask> take_background_tasks();
  ArchiveBatch finish();
  std::vector<RunSummary> summaries() const;

 private:
  ThreeAxisPass new_pass() const;
  void begin(const std::string& run_id);
  RunSummary summary() const;
  void note(const ThreeAxisOutput& output);
  void record(const PassInput& input);
  template <class Value>
  void record(const Arrived<Value>& arrived);
  void record(const OperatorAction& action);
  void hand_out_solutions();
  BackgroundTask solving(std::shared_ptr<const ReconstructionRequest> request,
                         std::optional<ReconstructionMethod> method) const;
  BackgroundTask solving_at_end() const;
  bool is_stored(ReconstructionMethod method) const;
  bool has_separation() const;
  void end_run(std::vector<ArchiveBatch>& batches);

  ThreeAxisConfig config_;
  std::optional<Orbit> orbit_;
  std::optional<MainFieldModel> field_;  ///< Where there is a magnetometer.
  std::optional<SeparationPlan> separation_;
  std::deque<RunSummary> finished_;  ///< They stay where they are: their last tasks point to them.
  RunSummary summary_;
  PassComputing<ThreeAxisPass> computing_;
  SolvingPlan plan_;
  std::optional<SeparationRecord> record_;  ///< Where the mission tells of a separation.
  Exclusions<SampleKind> excluded_;         ///< From it.
  bool has_forgotten_ = false;              ///< What a solution rested on.
  std::vector<BackgroundTask> due_;
};

}  // namespace spindrift
