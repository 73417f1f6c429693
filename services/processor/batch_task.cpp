#include "services/processor/batch_task.h"

#include <utility>

#include "pipelines/spin/batch/batch_estimator.h"

namespace spindrift {

Expected<BatchSolution> solve(BatchTask task) {
  const auto starts = task.pass.starts(task.config->prior);
  return solve_batch(*task.config, *task.orbit, std::move(task.pass).edges(), starts);
}

ArchiveBatch archived(const BatchTask& task, BatchSolution solution) {
  ArchiveBatch batch;
  batch.run_id = task.run_id;
  batch.spacecraft_id = task.spacecraft_id;
  batch.products.emplace_back(solution.estimate);
  batch.batch = std::move(solution);
  return batch;
}

}  // namespace spindrift
