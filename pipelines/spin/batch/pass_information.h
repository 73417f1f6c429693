/// @file
/// The normal equations of all edges of a pass at a state, in the unknowns of pass_model.h, and the
/// misfit.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

/// Residual, in sigmas of EdgeResidual::sigma(), beyond which an edge has no weight in Tukey's
/// biweight.
inline constexpr double kOutlierSigmas = 8.0;
/// Share of outliers beyond which a state explains nothing.
inline constexpr double kMostOutliers = 0.5;
/// Share of the information of normal noise that Tukey's weights leave, and the mean slope of the
/// weighted residual.
inline constexpr double kEfficiency = 0.99401;
inline constexpr double kMeanSlope = 0.90991;

struct PassInformation {
  Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns> information =
      Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>::Zero();
  /// Slopes times residuals; the step -(information^-1 score) of the unknowns makes it zero.
  Eigen::Matrix<double, kBatchUnknowns, 1> score = Eigen::Matrix<double, kBatchUnknowns, 1>::Zero();
  Considered<kBatchUnknowns, kSpinConsidered> considered = {};  ///< Terms of model_allowance.h.
  SensorBiases bias_sigmas = range_sigmas();                    ///< Priors of the biases.
  double squares = 0.0;                                         ///< Sum of the squared residuals.
  std::int64_t edges = 0;
  std::int64_t outliers = 0;  ///< Number of outliers, not counted in `edges`.

  PassInformation& operator+=(const PassInformation& other);
  double outlier_share() const;
  double misfit() const;  ///< Sum of squares in which each outlier counts kOutlierSigmas squared.
  /// Returns the ratio of the observed to the stated variance; 1 unless significantly more.
  /// @param unknowns Number of unknowns estimated from these edges.
  double excess_noise(int unknowns) const;
  /// Returns the equations with the considered parameters, which are no biases, eliminated.
  PassInformation less_considered(const ConsideredPrior& prior) const;
};

/// @param outlier_sigmas Infinity for a state so far off that all edges seem outliers.
PassInformation information_of(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& state, double outlier_sigmas = kOutlierSigmas);

/// Holds the equations of one of at most `spans` spans with equally many edges, at least one each.
struct SpanInformation {
  TaiTime begin;
  std::size_t first_edge;
  PassInformation of;
};
std::vector<SpanInformation> information_by_span(const PassModel& model,
                                                 std::span<const PassEdge> edges,
                                                 const SpinState& state, std::size_t spans);

}  // namespace spindrift
