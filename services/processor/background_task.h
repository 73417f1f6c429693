/// @file
/// A slow solution: a closure that a run hands out, and that whoever has the time calls.

#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// When slow solutions are made, beside the end of the pass.
enum class SolvingPlan { AtTheEnd, Meanwhile };

/// Either with the products of a solution, or why there is none.
using Solve = std::function<Expected<std::vector<Product>>()>;

/// Those of a run are solved and stored in the order in which it handed them out.
struct BackgroundTask {
  ArchiveBatch batch;             ///< For the archive, with what `solve` gives, if anything.
  Solve solve;                    ///< On any thread, while the run that handed it out is there.
  RunSummary* summary = nullptr;  ///< Of the run that has ended with it: it is counted there.
  std::string_view what = "batch solution";  ///< As people call it.
  bool is_awaited = false;  ///< By people, within seconds: it waits for none that is not.
};

/// What `solve` gives; what it throws becomes a RunFault at `t`, and is said in the log.
Expected<std::vector<Product>> solved_or_fault(const std::string& spacecraft_id,
                                               std::string_view what, TaiTime t,
                                               const Solve& solve);

/// @return Unobservable when any of them is withheld.
Expected<std::vector<Product>> unless_withheld(std::vector<Product> products);

}  // namespace spindrift
