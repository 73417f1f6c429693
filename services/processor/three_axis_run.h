/// @file
/// The computing side of a three-axis spacecraft's run: samples in, products out.

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

/// Runs the pass of a three-axis spacecraft; its functions are called as those of SpinRun. When the
/// mission describes a separation, the separation is reconstructed at the end of the pass from all
/// samples. Except offline, it is also reconstructed whenever SeparationRecord says so, by `batch`
/// first and then by `sequential`.
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
  std::optional<MainFieldModel> field_;  ///< Set when there is a magnetometer.
  std::optional<SeparationPlan> separation_;
  std::deque<RunSummary> finished_;  ///< A deque, since tasks point to its elements.
  RunSummary summary_;
  PassComputing<ThreeAxisPass> computing_;
  SolvingPlan plan_;
  std::optional<SeparationRecord> record_;  ///< Set when the mission describes a separation.
  Exclusions<SampleKind> excluded_;         ///< Samples that operators exclude from `record_`.
  bool has_forgotten_ = false;              ///< A sample that a solution used was dropped.
  std::vector<BackgroundTask> due_;
};

}  // namespace spindrift
