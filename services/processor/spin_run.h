/// @file
/// The computing side of a spinner's run: samples in, products for the archive out.

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

/// The estimator `batch` runs over all edges at the end of the pass; meanwhile every minute of
/// telemetry, and from then on when the stream falls silent; then each time, in the end too, over
/// the last revolutions.
///
/// What throws while it is computed becomes a RunFault: a run that fails so computes nothing more
/// (pass_computing.h), of a batch solution that does only this one is missing.
class SpinRun {
 public:
  static constexpr std::int64_t kLastRevolutions = 1000;

  /// What `batch` is given of the pass beside its edges.
  struct Known {
    std::optional<SpinPrior> prior;  ///< In the place of the mission's.
    std::optional<AxisChoice> choice;
  };

  /// @param mission Of a spinner.
  SpinRun(const Mission& mission, const std::string& run_id, SolvingPlan plan);

  /// The runs of `made`, of which `first` is the oldest, are stored, and their samples come again
  /// first.
  void go_on(const std::string& first, AllMadeBefore made);

  std::vector<ArchiveBatch> compute(const PassInput& input);

  /// What became due while computing; to be solved by whoever has the time. A run that has ended is
  /// finished by the last of its tasks.
  std::vector<BackgroundTask> take_background_tasks();

  /// The pass has ended: what was still held, its batch solution, and the end of the run.
  ArchiveBatch finish();

  /// Of all runs so far, but for what was received, which this side does not see. Once all tasks
  /// are solved.
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
  std::deque<RunSummary> finished_;  ///< They stay where they are: their last tasks point to them.
  RunSummary summary_;
  PassComputing<SpinPass> computing_;
  SolvingPlan plan_;
  PassEdges edges_;
  std::optional<TaiTime> next_batch_;
  std::optional<TaiTime> last_batch_;    ///< The last edge of the solution that was due last.
  std::optional<TaiTime> last_silence_;  ///< Its last edge, when one was solved.
  std::vector<BackgroundTask> due_;
};

}  // namespace spindrift
