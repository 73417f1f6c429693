/// @file
/// The computing side of a spinner's run: takes samples in and gives products for the archive.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/mission/mission.h"
#include "services/processor/pass_run.h"

namespace spindrift {

/// Runs the pass of a spinner and its `batch` estimator. Offline `batch` runs once, over all edges,
/// at the end of the pass. Otherwise it also runs every minute of telemetry and, after the first
/// minute, when the stream falls silent; then every solution, the last one included, uses only the
/// last kLastRevolutions revolutions.
class SpinRun : public PassRun<SpinRun, SpinPass> {
 public:
  static constexpr std::int64_t kLastRevolutions = 1000;

  /// What `batch` needs to know about the pass beside its edges.
  struct Known {
    std::optional<SpinPrior> prior;  ///< Used instead of the mission's prior.
    std::optional<AxisChoice> choice;
  };

  SpinRun(const Mission& mission, const std::string& run_id, SolvingPlan plan);

 private:
  friend PassRun;
  static constexpr SpacecraftKind kKind = SpacecraftKind::Spin;
  static constexpr std::string_view kNoSolution = "no_batch_solution";

  void forget();
  auto noting() {
    return [this](const auto& made) { return note(made); };
  }
  void settle(std::vector<Product>& products);
  std::optional<BackgroundTask> last_solution();
  bool expects_solution() const;

  void note(const SpinOutput& output);
  std::vector<Notice> note(const OperatorAction& action);
  void note(FellSilent silence);
  void note_time(TaiTime t);
  void make_batch_due();
  bool is_stored(TaiTime batch) const;
  enum class Solution { OnTheWay, Last };
  Known known() const { return {computing_.pass().told_prior(), computing_.pass().axis_choice()}; }
  Expected<std::vector<Product>> solve(const PassEdges& edges, const Known& known,
                                       Solution which) const;

  SpinConfig config_;
  Orbit orbit_;
  PassEdges edges_;
  std::optional<TaiTime> next_batch_;
  std::optional<TaiTime> last_batch_;  ///< Time of the last edge of the newest due solution.
  /// Time of the last edge at the last silence that made a solution due.
  std::optional<TaiTime> last_silence_;
};

}  // namespace spindrift
