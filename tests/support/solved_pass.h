/// @file
/// Solves the edges of a whole pass with `batch`, as `process` does at its end.

#pragma once

#include <utility>

#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "tests/support/product_text.h"

namespace spindrift::testing {

inline Expected<BatchSolution> solved(const SpinConfig& config, const Orbit& orbit,
                                      const SpinOutput& output) {
  PassEdges edges;
  for (const SpinProduct& product : output.products) {
    edges.collect(product);
  }
  const auto starts = edges.starts(config.prior);
  return solve_batch(config, orbit, std::move(edges).edges(), starts);
}

}  // namespace spindrift::testing
