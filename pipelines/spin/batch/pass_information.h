/// @file
/// The normal equations of all edges of a pass at a state, in the unknowns of pass_model.h, and the
/// misfit.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/channel_offsets.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

/// Farther from where the state has it (sigmas) an edge has no weight: Tukey's biweight.
inline constexpr double kOutlierSigmas = 8.0;
/// With a larger share of outliers nothing is explained.
inline constexpr double kMostOutliers = 0.5;
/// Of normal noise so weighted, the share of its information that is left, and the mean slope of
/// the weighted residual.
inline constexpr double kEfficiency = 0.99401;
inline constexpr double kMeanSlope = 0.90991;

struct PassInformation {
  Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns> information =
      Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>::Zero();
  /// Slopes times residuals: where a step of the unknowns by -(information^-1 score) leads to zero.
  Eigen::Matrix<double, kBatchUnknowns, 1> score = Eigen::Matrix<double, kBatchUnknowns, 1>::Zero();
  Considered<kBatchUnknowns, kChannelOffsets> offsets = {};  ///< Of the channels' times.
  double squares = 0.0;                                      ///< Of the residuals.
  std::int64_t edges = 0;
  std::int64_t outliers = 0;  ///< Not among these.

  PassInformation& operator+=(const PassInformation& other);
  double outlier_share() const;
  double misfit() const;  ///< Squares, an outlier's as the least that it may be.
  /// How many times their variance is what the stated noise makes it; 1 unless significantly more.
  /// @param unknowns Estimated from these edges.
  double excess_noise(int unknowns) const;
  /// What they say whatever the offsets of the channels' times are, which are no biases.
  PassInformation less_offsets(const OffsetPrior& offsets_s2) const;
};

/// @param outlier_sigmas Infinity for a state so far off that all edges seem outliers.
PassInformation information_of(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& state, double outlier_sigmas = kOutlierSigmas);

/// The same by spans of the pass that hold equally many edges. At most `spans`, each at least one.
struct SpanInformation {
  TaiTime begin;
  std::size_t first_edge;
  PassInformation of;
};
std::vector<SpanInformation> information_by_span(const PassModel& model,
                                                 std::span<const PassEdge> edges,
                                                 const SpinState& state, std::size_t spans);

}  // namespace spindrift
