/// @file
/// Counts of a run and its latest results, gathered from its products.

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
  /// Counts by plural name of the kind, e.g. "gyro samples".
  std::map<std::string_view, std::int64_t> samples_received = {};
  std::int64_t edges_received = 0;         ///< Includes edges of coded frames.
  std::int64_t edges_stored = 0;           ///< Filled in by the caller that reads the archive.
  std::int64_t coded_frames_received = 0;  ///< A frame holds up to six edges.
  std::int64_t edges_accepted = 0;
  std::map<std::string_view, std::int64_t>
      edges_rejected;               ///< Number of edges by the test that rejected them.
  std::int64_t input_rejected = 0;  ///< Rows and samples that are not valid input.
  std::int64_t revolutions = 0;
  std::int64_t fixes = 0;
  std::int64_t fixes_accepted = 0;
  std::map<int, std::int64_t> fixes_by_case;
  std::map<std::string_view, std::int64_t> fixes_by_resolution;  ///< By name; includes AMBIGUOUS.
  std::map<SpinEstimator, SpinEstimate> estimates;               ///< The latest of each estimator.
  std::optional<BatchSolution> batch;
  /// @name Three-axis spacecraft only
  /// @{
  SensorHealths sensors = {};
  /// Rejected samples by kind, then by name of the rejecting test.
  std::array<std::map<std::string_view, std::int64_t>, kSampleKinds> samples_rejected = {};
  std::optional<AttitudeEstimate> attitude;                 ///< The latest estimate.
  std::optional<Advisory> advisory = {};                    ///< Present while the body is lost.
  std::vector<ReconstructionProduct> reconstructions = {};  ///< One reconstruction for each method.
  /// @}
  std::vector<Disagreement> disagreements = {};  ///< Read from the archive.
  std::vector<RunFault> faults = {};             ///< Read from the archive.
  std::map<std::string, std::int64_t> contradictions = {};
  PassVerdict verdict = {};  ///< Read from the archive.
  /// Residuals of the edges in `sequential`, or of the samples in the attitude filter.
  Ledger ledger{kShownRules};

  void count(const SpinProduct& product);
  void count(const ThreeAxisProduct& product);

  /// Counts the solution of `batch` or of a reconstruction if `products` contains one.
  void count_solution(const std::vector<Product>& products);

  /// Geometry case of every revolution whose fix is AMBIGUOUS, by revolution. A resolved fix may
  /// replace it later, and is then not counted twice.
  std::map<std::int64_t, int> ambiguous = {};
};

}  // namespace spindrift
