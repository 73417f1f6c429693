/// @file
/// The computing side of a three-axis spacecraft's run: samples in, products out.

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/reconstruction/separation_record.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "services/mission/mission.h"
#include "services/processor/pass_run.h"

namespace spindrift {

/// Runs the pass of a three-axis spacecraft. When the mission describes a separation, the
/// separation is reconstructed at the end of the pass from all samples. Except offline, it is also
/// reconstructed whenever SeparationRecord says so, by `batch` first and then by `sequential`.
class ThreeAxisRun : public PassRun<ThreeAxisRun, ThreeAxisPass> {
 public:
  ThreeAxisRun(const Mission& mission, const std::string& run_id, SolvingPlan plan);

  std::vector<ArchiveBatch> compute(const PassInput& input);

 private:
  friend PassRun;
  static constexpr SpacecraftKind kKind = SpacecraftKind::ThreeAxis;
  static constexpr std::string_view kNoSolution = "no_reconstruction";

  void forget();
  auto noting() {
    return [this](const ThreeAxisOutput& output) { note(output); };
  }
  std::optional<BackgroundTask> last_solution() const;
  bool expects_solution() const { return record_ && sample_count(record_->request()) > 0; }

  void note(const ThreeAxisOutput& output);
  void record(const PassInput& input);
  template <class Value>
  void record(const Placed<Value>& placed);
  void record(const Placed<OperatorAction>& placed);
  void hand_out_solutions();
  BackgroundTask solving(std::shared_ptr<const ReconstructionRequest> request,
                         std::optional<ReconstructionMethod> method) const;
  bool is_stored(ReconstructionMethod method) const;

  ThreeAxisConfig config_;
  std::optional<Orbit> orbit_;
  std::optional<SeparationPlan> separation_;
  std::optional<SeparationRecord> record_;  ///< Set when the mission describes a separation.
  Exclusions<SampleKind> excluded_;         ///< Samples that operators exclude from `record_`.
  bool has_forgotten_ = false;              ///< A sample that a solution used was dropped.
};

}  // namespace spindrift
