/// @file
/// The estimator `batch` for the edges that a pass has so far: a value that any thread may solve.

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/types/config.h"
#include "services/archive/records.h"

namespace spindrift {

struct BatchTask {
  std::string run_id;
  std::string spacecraft_id;
  const SpinConfig* config;  ///< Of the PassRun, which outlives the task; so is the orbit.
  const Orbit* orbit;
  PassEdges pass;
};

Expected<BatchSolution> solve(BatchTask task);

/// Its estimate, and what else it says.
void add_products(BatchSolution solution, ArchiveBatch& batch);

/// For the archive.
ArchiveBatch archived(const BatchTask& task, BatchSolution solution);

}  // namespace spindrift
