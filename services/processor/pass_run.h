/// @file
/// What the computing sides of all kinds of spacecraft do alike.

#pragma once

#include <fmt/format.h>

#include <deque>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/archive/records.h"
#include "services/base/wall_clock.h"
#include "services/mission/mission.h"
#include "services/processor/background_task.h"
#include "services/processor/pass_computing.h"
#include "services/processor/run_summary.h"
#include "services/processor/told.h"

namespace spindrift {

/// The computing side of a run: takes samples in and gives products and slow solutions. An
/// exception in the pass becomes a RunFault, and nothing more is computed for the run
/// (pass_computing.h). An exception in a slow solution becomes a RunFault too, but only that
/// solution is missing.
/// @tparam Run Inherits this and has: `kKind`; `kNoSolution`, code of the notice that the last
/// solution could not be made; `forget`, which drops what belongs to the run before; `noting`,
/// which returns the function that PassComputing calls with what the pass makes; `last_solution`,
/// which returns the task of the solution at the end of the run, or nothing when there is nothing
/// to solve; `expects_solution`, whether a user misses that solution when it cannot be made. It may
/// replace `settle`.
template <class Run, class Pass>
class PassRun {
 public:
  /// Prepares for stored runs whose samples will come again, from the oldest, `first`, on.
  void go_on(const std::string& first, AllMadeBefore made) {
    computing_.go_on(std::move(made));
    begin(first);
  }

  std::vector<ArchiveBatch> compute(const PassInput& input) {
    std::vector<ArchiveBatch> batches;
    if (input.run_id != computing_.run_id()) {
      end_run(batches);
      begin(input.run_id);
    }
    auto computed = computing_.compute(input, run().noting());
    std::move(computed.begin(), computed.end(), std::back_inserter(batches));
    return batches;
  }

  /// Returns the due tasks. The last task of an ended run also finishes it.
  std::vector<BackgroundTask> take_background_tasks() { return std::exchange(due_, {}); }

  /// Ends the pass: returns the products it still held back, its last solution and the end of the
  /// run.
  ArchiveBatch finish() {
    ArchiveBatch last = computing_.batch();
    run().settle(last.products);
    if (const std::optional<BackgroundTask> solution = run().last_solution()) {
      if (auto products = solution->solve()) {
        summary_.count_solution(*products);
        std::move(products->begin(), products->end(), std::back_inserter(last.products));
      } else if (run().expects_solution()) {
        const std::string& why = products.error().message;
        last.products.emplace_back(
            told(Run::kNoSolution, {{"spacecraft", computing_.spacecraft_id()}, {"why", why}},
                 fmt::format("{}: no {}: {}", computing_.spacecraft_id(), solution->what, why)));
      }
    }
    last.finished_utc = utc_now();
    return last;
  }

  /// Returns the summaries of all runs so far, without the counts of received samples, which this
  /// side does not see. To be called when all tasks are solved.
  std::vector<RunSummary> summaries() const {
    std::vector<RunSummary> summaries{finished_.begin(), finished_.end()};
    summaries.push_back(summary());
    return summaries;
  }

 protected:
  /// @param fresh A pass without samples; each run begins with a copy.
  PassRun(const Mission& mission, const std::string& run_id, Pass fresh, SolvingPlan plan)
      : plan_{plan},
        computing_{mission.spacecraft_id, run_id, fresh, mission.stores_residuals},
        fresh_{std::move(fresh)} {}

  void begin(const std::string& run_id) {
    computing_.begin(run_id, fresh_);
    summary_ = {};
    summary_.run_id = run_id;
    summary_.spacecraft_id = computing_.spacecraft_id();
    summary_.kind = Run::kKind;
    run().forget();
  }

  /// Ends the pass and appends the products that it still held back.
  void settle(std::vector<Product>& products) { computing_.finish(products, run().noting()); }

  SolvingPlan plan_;
  PassComputing<Pass> computing_;
  RunSummary summary_;
  std::vector<BackgroundTask> due_;

 private:
  Run& run() { return static_cast<Run&>(*this); }

  RunSummary summary() const {
    RunSummary summary = summary_;
    if constexpr (requires { computing_.pass().sensors(); }) {
      summary.sensors = computing_.pass().sensors();
    }
    return summary;
  }

  /// When solutions of the run may still wait to be solved, the run is finished by a task behind
  /// them, so that a finished run lacks none.
  void end_run(std::vector<ArchiveBatch>& batches) {
    if (plan_ == SolvingPlan::AtTheEnd) {
      batches.push_back(finish());
      finished_.push_back(summary());
      return;
    }
    ArchiveBatch& held = batches.emplace_back(computing_.batch());
    run().settle(held.products);
    RunSummary& ended = finished_.emplace_back(summary());
    if (auto last = run().last_solution()) {
      last->batch.finished_utc = utc_now();
      last->summary = &ended;
      due_.push_back(*std::move(last));
    } else {
      held.finished_utc = utc_now();
    }
  }

  Pass fresh_;
  std::deque<RunSummary> finished_;  ///< A deque, since tasks point to its elements.
};

}  // namespace spindrift
