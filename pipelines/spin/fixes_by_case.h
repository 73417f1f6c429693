/// @file
/// The fixes of a pass for their mean, kept apart by geometry case.
///
/// Where fixes are left out because of what their noise made of them (two roots that come together
/// within it, candidates that it brought too near to each other), those that remain are a selection
/// and lie to one side. Of a normal vector of unit variance, the mean over any event of probability
/// p is at most sqrt(2 ln(1/p)) long, as its relative entropy, ln(1/p), is at least half the square
/// of that; and by the same for what is left out, at most (1-p)/p sqrt(2 ln(1/(1-p))).
///
/// A shift of every fix by s of its sigmas moves the least-squares mean, whose covariance is C, in
/// no direction d by more than the root of
///
///     s^2 n  d' C I C d        (Cauchy and Schwarz over the n fixes),
///
/// with the information I that these fixes bring: so they count by what they weigh, not by their
/// number. Unlike noise, it does not average out.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <utility>

#include "pipelines/spin/angle_equations.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/sightlines.h"

namespace spindrift {

/// What a selection of so many of all normal vectors is shifted by at most, in sigmas.
/// @param share (0, 1].
double most_shift_sigmas(double share);

/// Mean of the cases that together leave the axis the least uncertain: what a selection adds may be
/// less than what it shifts.
struct MeanOfCases {
  AngleEquations equations;
  Eigen::Matrix2d covariance_rad2;  ///< Noise and shift. Tangent plane: east, north.
  std::size_t count;                ///< Fixes.
  double settled_share;  ///< Of the fixes that there might be, each case by its weight in the mean.
};

class FixesByCase {
 public:
  /// @param reference_icrf Unit; as AngleEquations.
  explicit FixesByCase(Eigen::Vector3d reference_icrf)
      : reference_icrf_{std::move(reference_icrf)} {}

  /// @param axis_icrf As AngleEquations.
  void add(int geometry_case, const SpinConfig& config, const RevolutionMeasurements& measured,
           const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf);

  /// There must be a fix.
  MeanOfCases mean(const std::map<int, double>& left_out) const;

 private:
  struct OfCase {
    AngleEquations equations;
    std::size_t count = 0;
  };

  Eigen::Vector3d reference_icrf_;
  std::map<int, OfCase> cases_;
};

}  // namespace spindrift
