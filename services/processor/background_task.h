/// @file
/// A slow solution as a closure that a run hands out and a background thread calls later.

#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Whether slow solutions are made only at the end of the pass or also while it goes on.
enum class SolvingPlan { AtTheEnd, Meanwhile };

/// Returns the products of a solution, or the reason why there is none.
using Solve = std::function<Expected<std::vector<Product>>()>;

/// Holds one slow solution. The tasks of a run are solved and stored in the order handed out.
struct BackgroundTask {
  ArchiveBatch batch;                        ///< Goes to the archive with the products of `solve`.
  Solve solve;                               ///< Callable on any thread while its run exists.
  RunSummary* summary = nullptr;             ///< Counts the solution; null while the run goes on.
  std::string_view what = "batch solution";  ///< Name of the solution in messages.
  bool is_awaited = false;  ///< Users wait for it within seconds: not queued behind others.
};

/// Calls `solve`. An exception that it throws is logged and becomes a RunFault at `t`.
Expected<std::vector<Product>> solved_or_fault(const std::string& spacecraft_id,
                                               std::string_view what, TaiTime t,
                                               const Solve& solve);

/// Returns `products`, or Unobservable when any of them holds a number that is not finite.
Expected<std::vector<Product>> unless_withheld(std::vector<Product> products);

}  // namespace spindrift
