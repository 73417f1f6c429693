/// @file
/// The computing side of one spacecraft's run: samples in, products for the archive out.

#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/background_task.h"
#include "services/processor/pass_input.h"
#include "services/processor/run_summary.h"
#include "services/processor/withheld.h"

namespace spindrift {

/// When the estimator `batch` runs, beside the end of the pass.
enum class BatchPlan {
  WholePass,   ///< Then only, over all edges.
  EveryMinute  ///< Of telemetry; each time, in the end too, over the last revolutions.
};

/// What is stored of a run that goes on.
struct MadeBefore {
  /// What was made from then on, which the run may not have got to, is stored again.
  TaiTime again_from;
  std::vector<TaiTime> batches;  ///< When solutions of `batch` are; in order.
};

/// What throws while it is computed becomes a RunFault. A run that fails so computes nothing more;
/// of a batch solution that does only this one is missing.
class PassRun {
 public:
  static constexpr std::int64_t kLastRevolutions = 1000;

  /// @param mission Of a spinner.
  PassRun(const Mission& mission, const std::string& run_id, BatchPlan plan);

  /// The runs of `made`, of which `first` is the oldest, are stored, and their samples come again
  /// first.
  void go_on(const std::string& first, std::map<std::string, MadeBefore> made);

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
  ArchiveBatch batch() const;
  /// First the results, then what may be stored later (detail_lane.h), each kind by itself.
  using Computed = std::array<ArchiveBatch, 1 + std::variant_size_v<Product>>;
  void compute(const PassInput& input, Computed& computed);
  /// @param t Of the sample that made it; none: a silence did.
  void keep(SpinOutput output, std::optional<TaiTime> t, Computed& computed);
  void note(const SpinOutput& output);
  void note_time(TaiTime t);
  bool is_stored(TaiTime batch) const;
  void settle(std::vector<Product>& products);
  template <class Compute>
  void compute_or_fail(std::vector<Product>& products, const Compute& compute);
  void end_run(std::vector<ArchiveBatch>& batches);
  Expected<std::vector<Product>> solve(const PassEdges& edges) const;

  std::string spacecraft_id_;
  SpinConfig config_;
  Orbit orbit_;
  std::deque<RunSummary> finished_;  ///< They stay where they are: their last tasks point to them.
  RunSummary summary_;
  SpinPass pass_;
  std::map<std::string, MadeBefore> made_before_;  ///< By run.
  std::optional<TaiTime> again_from_;  ///< Until the pass is there again: what it makes is stored.
  TaiTime reached_ = {};               ///< The sample that was computed last.
  bool failed_ = false;
  BatchPlan plan_;
  PassEdges edges_;
  std::optional<TaiTime> next_batch_;
  std::optional<TaiTime> last_batch_;  ///< The last edge of the solution that was due last.
  std::vector<BackgroundTask> due_;
  Withheld withheld_;
};

}  // namespace spindrift
