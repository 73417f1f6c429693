/// @file
/// What the ordinary pipelines made of a simulated pass, against its truth.

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/processor/run_summary.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// One number of a run.
struct Measure {
  std::string name;             ///< With its unit: "batch_error_deg".
  std::optional<double> value;  ///< Empty: there is no such answer in this run.
};

/// Of a spinner the error of each estimator's axis at the end; of a separation that of each
/// method's attitude at T1; of every three-axis spacecraft that of the filter's last attitude; each
/// with its normalised square e' P^-1 e, whose mean is 2 of an axis and 3 of an attitude. Of an
/// orientation what its control reached, too, as in truth.json.
/// @return the same names for every run of a scenario.
std::vector<Measure> run_outcome(const Scenario& scenario, const SimulatedPass& pass,
                                 const RunSummary& summary);

}  // namespace spindrift
