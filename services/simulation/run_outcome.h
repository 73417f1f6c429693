/// @file
/// Errors of the ordinary pipelines' solutions of a simulated pass against its truth.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/processor/run_summary.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Result of a run in one number.
struct Measure {
  std::string name;             ///< Name with its unit, e.g. "batch_error_deg".
  std::optional<double> value;  ///< Value; empty where the run has no such result.
};

/// Returns the error of each estimator's axis at the end (spinner), of each method's attitude at T1
/// (separation), and of the filter's last attitude (every three-axis spacecraft), each with its
/// normalised square e' P^-1 e, whose mean is 2 for an axis and 3 for an attitude. For an
/// orientation the results of the control are added, as in truth.json.
/// @return The same names for every run of a scenario.
std::vector<Measure> run_outcome(const Scenario& scenario, const SimulatedPass& pass,
                                 const RunSummary& summary);

}  // namespace spindrift
