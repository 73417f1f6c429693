#include "services/processor/spin_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "pipelines/spin/batch/batch_estimator.h"
#include "services/processor/told.h"

namespace spindrift {
namespace {

constexpr std::chrono::minutes kBetweenBatches{1};

Expected<BatchSolution> solve_edges(SpinConfig config, const Orbit& orbit, PassEdges edges,
                                    const SpinRun::Known& known) {
  config.prior = known.prior;
  StartingAxes starts = edges.starts(known.prior);
  starts.of_pass = known.choice;
  const bool noise_chose = edges.noise_chose_among_copies();
  const auto contradiction = edges.contradiction();
  auto solution = spindrift::solve_batch(config, orbit, std::move(edges).edges(), starts);
  if (solution && noise_chose) {
    doubt(solution->estimate.assessment, {ReasonCode::CopiesInNoise});
  }
  if (solution && contradiction) {
    doubt(solution->estimate.assessment, reason_of(*contradiction));
  }
  return solution;
}

/// Returns the solution as products: its estimate, its choice of the axis, what it says of the
/// mission file and the solution itself.
Expected<std::vector<Product>> batch_products(BatchSolution solution, bool keeps_residuals) {
  if (!keeps_residuals) {
    solution.said = {};
  }
  return unless_withheld({solution.estimate, solution.choice, solution.equations,
                          std::make_shared<const BatchSolution>(std::move(solution))});
}

}  // namespace

SpinRun::SpinRun(const Mission& mission, const std::string& run_id, SolvingPlan plan)
    : PassRun{mission, run_id, SpinPass{*mission.spin(), *mission.orbit}, plan},
      config_{*mission.spin()},
      orbit_{*mission.orbit} {
  begin(run_id);
}

void SpinRun::forget() {
  edges_ = {};
  next_batch_.reset();
  last_batch_.reset();
  last_silence_.reset();
}

/// Uses telemetry time, so that the same telemetry gives the same solutions.
void SpinRun::note_time(TaiTime t) {
  if (plan_ == SolvingPlan::AtTheEnd || (next_batch_ && t < *next_batch_)) {
    return;
  }
  if (next_batch_) {
    make_batch_due();
  }
  next_batch_ = t + kBetweenBatches;
}

/// A silence may be the end of the stream, so a solution of all edges so far is made.
void SpinRun::note(FellSilent /*silence*/) {
  // In the first minute of the pass a solution would rest on too little telemetry, and would stand
  // beside estimates that rest on more.
  const auto last = last_batch_ ? edges_.last() : std::nullopt;
  if (last && (!last_silence_ || *last >= *last_silence_ + kBetweenSilences)) {
    last_silence_ = last;
    make_batch_due();
  }
}

void SpinRun::make_batch_due() {
  edges_.keep_last(kLastRevolutions);
  const auto last = edges_.last();
  // A solution is identified by the time of its last edge, so there is only one per last edge.
  if (last && last != last_batch_ && !is_stored(*last)) {
    due_.push_back({.batch = computing_.batch(), .solve = [this, edges = edges_, known = known()] {
                      return solve(edges, known, Solution::OnTheWay);
                    }});
  }
  last_batch_ = last;
}

/// Returns whether this solution is stored and will not be made again.
bool SpinRun::is_stored(TaiTime batch) const {
  const MadeBefore* const made = computing_.made_before();
  return made != nullptr && batch < made->again_from &&
         std::binary_search(made->batches.begin(), made->batches.end(), batch);
}

/// Only the last solution keeps residuals of the edges: each would replace those before.
Expected<std::vector<Product>> SpinRun::solve(const PassEdges& edges, const Known& known,
                                              Solution which) const {
  const bool keeps_residuals = which == Solution::Last;
  return solved_or_fault(computing_.spacecraft_id(), "batch solution",
                         edges.last().value_or(TaiTime{}), [&] {
                           return solve_edges(config_, orbit_, edges, known)
                               .and_then([keeps_residuals](BatchSolution solution) {
                                 return batch_products(std::move(solution), keeps_residuals);
                               });
                         });
}

/// Ends the pass and drops the solutions that this makes due: the last solution covers them.
void SpinRun::settle(std::vector<Product>& products) {
  const std::size_t due = due_.size();
  PassRun::settle(products);
  due_.erase(due_.begin() + static_cast<std::ptrdiff_t>(due), due_.end());
  if (plan_ == SolvingPlan::Meanwhile) {
    edges_.keep_last(kLastRevolutions);
  }
  if (edges_.forgot_some()) {
    products.emplace_back(
        told("batch_edges_forgotten",
             {{"spacecraft", computing_.spacecraft_id()}, {"edges", PassEdges::kMost}},
             fmt::format("{}: more edges than the batch solution can hold: it rests on the last {}",
                         computing_.spacecraft_id(), PassEdges::kMost)));
  }
}

std::optional<BackgroundTask> SpinRun::last_solution() {
  return BackgroundTask{.batch = computing_.batch(),
                        .solve = [this, failed = computing_.failed(),
                                  edges = std::exchange(edges_, {}), known = known()] {
                          return failed ? std::vector<Product>{}
                                        : solve(edges, known, Solution::Last);
                        }};
}

bool SpinRun::expects_solution() const {
  return summary_.edges_accepted > 0 || !summary_.edges_rejected.empty();
}

void SpinRun::note(const SpinOutput& output) {
  for (const SpinProduct& product : output.products) {
    summary_.count(product);
    edges_.collect(product);
    if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
      note_time(estimate->t);
    }
  }
}

/// Returns what the action does to edges that have come already.
std::vector<Notice> SpinRun::note(const OperatorAction& action) {
  const auto* const does = std::get_if<SpinAction>(&action.does);
  const std::size_t dropped = does == nullptr ? 0 : edges_.act(action.t.value(), *does);
  if (dropped == 0) {
    return {};
  }
  return {{NoticeCode::BatchLeavesOut,
           {{"t_tai_ns", tai_ns(*action.t)},
            {"edges", static_cast<std::int64_t>(dropped)},
            {"action", action.action}}}};
}

}  // namespace spindrift
