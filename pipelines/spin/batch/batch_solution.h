/// @file
/// Result of the estimator `batch` for one pass.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/observation/normal_equations.h"
#include "pipelines/spin/nutation/nutation.h"
#include "pipelines/spin/sensor_model/coning.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the estimate of one bias other than coning, from the edges and the prior together.
struct BiasEstimate {
  SensorBias bias;
  double value;  ///< Value in rad or km; zero, as in the prior, where not observable.
  double sigma;  ///< Standard deviation in rad or km; that of the prior where not observable.
  bool observable;
  bool estimated;             ///< False for a one-step estimate outside the solution.
  double stated_sigma = 0.0;  ///< Sigma that the mission file states, rad or km.
};

/// Holds the coning estimate: the sensors' axis leans away from the principal axis.
struct ConingEstimate {
  ConingTest verdict;  ///< Test of coning; detected only if coning was estimated with the axis.
  double tilt_sigma_rad;
  double azimuth_sigma_rad;
};

/// Holds the residual of one edge against the solution.
struct BatchEdge {
  Pulse pulse;
  /// Lateness of the edge against the prediction; empty when the state predicts no such edge.
  std::optional<double> residual_s;
  double sigma_s;  ///< Standard deviation by noise and alignment that the solution assumes, s.
  bool used;       ///< True within kOutlierSigmas.
};

struct BatchSolution {
  SpinEstimate estimate;
  double drift_rad_s2;  ///< Drift of the spin rate, constant over the pass.
  double drift_sigma_rad_s2;
  /// Cramer-Rao bound of the axis, both directions together, with the stated noise and the
  /// estimated biases.
  double bound_rad;
  /// All biases but coning. Those not estimated with the axis hold what the edges would give if all
  /// biases were estimated together.
  std::vector<BiasEstimate> biases;
  /// Bias directions that the edges leave open if all biases of the pass are unknown; each is one
  /// bias, or several that cannot be told apart.
  std::vector<BiasSet> undetermined;
  std::vector<double> singular_values;  ///< Values of the whitened equations, largest first.
  std::optional<TaiTime> changed;       ///< Time of the last change of attitude or rate.
  std::int64_t edges;                   ///< Number of edges that the solution rests on.
  std::int64_t outliers;
  double noise;  ///< Root mean square residual relative to the stated noise.
  int iterations;
  /// Nutation of the last stretch that has it; empty when the edges are too few to search.
  std::optional<NutationSearch> nutation;
  TaiTime nutation_t;  ///< Time of FoundNutation::t_s, else of the estimate.
  ConingEstimate coning;
  std::vector<BatchEdge> said = {};  ///< Residuals of all edges of the solution, in order of time.
  AxisChoice choice = {};
  /// What the pass says of the mission file: normal equations about the file's values.
  NormalEquations equations = {};
};

}  // namespace spindrift
