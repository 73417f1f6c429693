/// @file
/// The computing side of a spinner's run: takes samples in and gives products for the archive.

#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/background_task.h"
#include "services/processor/pass_computing.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Runs the pass of a spinner and its `batch` estimator. Offline `batch` runs once, over all edges,
/// at the end of the pass. Otherwise it also runs every minute of telemetry and, after the first
/// minute, when the stream falls silent; then every solution, the last one included, uses only the
/// last kLastRevolutions revolutions.
/// An exception in the pass becomes a RunFault, and nothing more is computed for the run
/// (pass_computing.h). An exception in a batch solution becomes a RunFault too, but only that
/// solution is missing.
class SpinRun {
 public:
  static constexpr std::int64_t kLastRevolutions = 1000;

  /// What `batch` needs to know about the pass beside its edges.
  struct Known {
    std::optional<SpinPrior> prior;  ///< Used instead of the mission's prior.
    std::optional<AxisChoice> choice;
  };

  SpinRun(const Mission& mission, const std::string& run_id, SolvingPlan plan);

  /// Prepares for stored runs whose samples will come again, from the oldest, `first`, on.
  void go_on(const std::string& first, AllMadeBefore made);

  std::vector<ArchiveBatch> compute(const PassInput& input);

  /// Returns the due tasks. The last task of an ended run also finishes it.
  std::vector<BackgroundTask> take_background_tasks();

  /// Ends the pass: returns the products it still held back, its batch solution and the end of the
  /// run.
  ArchiveBatch finish();

  /// Returns the summaries of all runs so far, without the counts of received samples, which this
  /// side does not see. To be called when all tasks are solved.
  std::vector<RunSummary> summaries() const;

 private:
  void begin(const std::string& run_id);
  void note(const SpinOutput& output);
  void note(const OperatorAction& action);
  void note(FellSilent silence);
  void note_time(TaiTime t);
  void make_batch_due();
  bool is_stored(TaiTime batch) const;
  void settle(std::vector<Product>& products);
  void end_run(std::vector<ArchiveBatch>& batches);
  enum class Solution { OnTheWay, Last };
  Known known() const { return {computing_.pass().told_prior(), computing_.pass().axis_choice()}; }
  Expected<std::vector<Product>> solve(const PassEdges& edges, const Known& known,
                                       Solution which) const;

  SpinConfig config_;
  Orbit orbit_;
  std::deque<RunSummary> finished_;  ///< A deque, since tasks point to its elements.
  RunSummary summary_;
  PassComputing<SpinPass> computing_;
  SolvingPlan plan_;
  PassEdges edges_;
  std::optional<TaiTime> next_batch_;
  std::optional<TaiTime> last_batch_;  ///< Time of the last edge of the newest due solution.
  /// Time of the last edge at the last silence that made a solution due.
  std::optional<TaiTime> last_silence_;
  std::vector<BackgroundTask> due_;
};

}  // namespace spindrift
