/// @file
/// The counts and the answer of a run, gathered as its products pass by.

#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/observation/ledger.h"
#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/three_axis/products.h"
#include "services/archive/verdict.h"
#include "services/mission/mission.h"
#include "services/products/products.h"

namespace spindrift {

struct RunSummary {
  std::string run_id;
  std::string spacecraft_id;
  SpacecraftKind kind = SpacecraftKind::Spin;
  std::map<std::string_view, std::int64_t> samples_received = {};  ///< "gyro samples"; what came.
  std::int64_t edges_received = 0;         ///< Those of coded frames too, as everywhere here.
  std::int64_t edges_stored = 0;           ///< Whoever knows the archive fills it in.
  std::int64_t coded_frames_received = 0;  ///< Each holds up to six edges.
  std::int64_t edges_accepted = 0;
  std::map<std::string_view, std::int64_t> edges_rejected;  ///< By the test that did it.
  std::int64_t input_rejected = 0;                          ///< Rows and samples that are none.
  std::int64_t revolutions = 0;
  std::int64_t fixes = 0;
  std::int64_t fixes_accepted = 0;
  std::map<int, std::int64_t> fixes_by_case;
  std::map<std::string_view, std::int64_t> fixes_by_resolution;  ///< AMBIGUOUS among them.
  std::map<SpinEstimator, SpinEstimate> estimates;               ///< The last of each.
  std::optional<BatchSolution> batch;
  /// @name Of a three-axis spacecraft
  /// @{
  SensorHealths sensors = {};
  /// By kind, and by the test that did it.
  std::array<std::map<std::string_view, std::int64_t>, kSampleKinds> samples_rejected = {};
  std::optional<AttitudeEstimate> attitude;                 ///< The last.
  std::vector<ReconstructionProduct> reconstructions = {};  ///< Of the separation, by each method.
  /// @}
  std::vector<Disagreement> disagreements = {};             ///< Likewise from the archive.
  std::vector<RunFault> faults = {};                        ///< Likewise.
  std::map<std::string, std::int64_t> contradictions = {};  ///< Likewise; by kind of sample.
  PassVerdict verdict = {};                                 ///< Likewise.
  /// What edges said to `sequential`, or samples to the filter.
  Ledger ledger{kShownRules};

  void count(const SpinProduct& product);
  void count(const ThreeAxisProduct& product);

  /// The last solution of `batch` or of a reconstruction, if it is among them.
  void count_solution(const std::vector<Product>& products);

  /// Case of every revolution whose fix is AMBIGUOUS: it may be given again, decided.
  std::map<std::int64_t, int> ambiguous = {};
};

}  // namespace spindrift
