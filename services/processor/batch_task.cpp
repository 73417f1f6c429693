#include "services/processor/batch_task.h"

#include <memory>
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
  add_products(std::move(solution), batch);
  return batch;
}

void add_products(BatchSolution solution, ArchiveBatch& batch) {
  batch.products.emplace_back(solution.estimate);
  batch.products.emplace_back(std::make_shared<const BatchSolution>(std::move(solution)));
}

}  // namespace spindrift
