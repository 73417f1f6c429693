/// @file
/// What the estimator `batch` finds out of a pass.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/spin/nutation/nutation.h"
#include "pipelines/spin/sensor_model/coning.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// One bias other than coning, as edges and prior together have it.
struct BiasEstimate {
  SensorBias bias;
  double value;  ///< rad, or km; zero, the prior, where not observable.
  double sigma;  ///< That of the prior where not observable.
  bool observable;
  bool estimated;  ///< With the axis. Of others: what one step makes of them, not in the axis.
};

/// The sensors' axis leans away from the principal axis.
struct ConingEstimate {
  ConingTest verdict;  ///< Detected only where it was estimated with the axis.
  double tilt_sigma_rad;
  double azimuth_sigma_rad;
};

/// What an edge said to the solution.
struct BatchEdge {
  Pulse pulse;
  /// Later than expected by so much; empty: the state has no such edge.
  std::optional<double> residual_s;
  double sigma_s;  ///< Of its noise, as the solution takes it.
  bool used;       ///< Within kOutlierSigmas.
};

struct BatchSolution {
  SpinEstimate estimate;
  double drift_rad_s2;  ///< Of the rate, even over the pass.
  double drift_sigma_rad_s2;
  /// Cramer-Rao bound of the axis, both directions together, with the stated noise and the biases
  /// that are estimated.
  double bound_rad;
  /// Root mean square error of the axis were no bias known better than by its prior, those held at
  /// zero included (consider analysis): what sensors out of place could hide.
  double consider_sigma_rad;
  /// Of every bias but coning: as estimated; of the others what the edges would say of all biases
  /// together.
  std::vector<BiasEstimate> biases;
  /// Directions that the edges leave open were all biases of the pass unknown: one bias, or those
  /// that cannot be told apart.
  std::vector<BiasSet> undetermined;
  std::vector<double> singular_values;  ///< Of the whitened equations, largest first.
  std::optional<TaiTime> changed;       ///< Attitude or rate did, the last time.
  std::int64_t edges;                   ///< That it rests on.
  std::int64_t outliers;
  double noise;  ///< Root of their mean square against the stated noise.
  int iterations;
  /// Empty where the edges do not suffice to look. What was found is the last stretch's.
  std::optional<NutationSearch> nutation;
  TaiTime nutation_t;  ///< Where FoundNutation says t_s; without one, that of the estimate.
  ConingEstimate coning;
  std::vector<BatchEdge> said = {};  ///< By all edges that it was solved with, in order of time.
  AxisChoice choice = {};
};

}  // namespace spindrift
