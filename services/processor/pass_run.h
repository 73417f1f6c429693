/// @file
/// The computing side of one spacecraft's run: samples in, products for the archive out.

#pragma once

#include <array>
#include <cstddef>
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

class PassRun {
 public:
  static constexpr std::int64_t kLastRevolutions = 1000;

  /// @param mission Of a spinner.
  PassRun(const Mission& mission, const std::string& run_id, BatchPlan plan);

  /// The run is `run_id`, which is stored, and its samples come again first. What was made from
  /// `again_from` on, which the run may not have got to, is stored again, and with it the results
  /// in force, so that they are announced again.
  void go_on(const std::string& run_id, TaiTime again_from);

  std::vector<ArchiveBatch> compute(const PassInput& input);

  /// What became due while computing; to be solved by whoever has the time.
  std::vector<BackgroundTask> take_background_tasks();

  /// The pass has ended: what was still held, its batch solution, and the end of the run.
  ArchiveBatch finish();

  /// Of all runs so far, but for what was received, which this side does not see.
  std::vector<RunSummary> summaries() const;

 private:
  void begin(const std::string& run_id);
  ArchiveBatch batch() const;
  /// First the results, then what may be stored later (detail_lane.h), each kind by itself.
  using Computed = std::array<ArchiveBatch, 1 + std::variant_size_v<Product>>;
  /// @param t Of the sample that made it; none: a silence did.
  void keep(SpinOutput output, std::optional<TaiTime> t, Computed& computed);
  void note(const SpinOutput& output);
  void note_time(TaiTime t);
  BackgroundTask batch_task() const;
  void solve_batch(ArchiveBatch& last);

  std::string spacecraft_id_;
  SpinConfig config_;
  Orbit orbit_;
  std::vector<RunSummary> finished_;
  RunSummary summary_;
  SpinPass pass_;
  std::optional<TaiTime> again_from_;  ///< Until the pass is there again: what it makes is stored.
  BatchPlan plan_;
  PassEdges edges_;
  std::optional<TaiTime> next_batch_;
  std::vector<BackgroundTask> due_;
  Withheld withheld_;
};

}  // namespace spindrift
