/// @file
/// What the spin pipeline gives: values to be stored and published, in the order they arise.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/core/rational.h"
#include "pipelines/observation/observation.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/sample_contradiction.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class SpinQuantity {
  Period,         ///< s
  SunAngle,       ///< rad
  NorthChord,     ///< rad
  SouthChord,     ///< rad
  NorthDihedral,  ///< rad
  SouthDihedral,  ///< rad
  MixedAzimuth,   ///< rad
};
inline constexpr std::size_t kSpinQuantities = 7;
std::string_view name_of(SpinQuantity quantity);

/// Of the test of a quantity.
Rejection rejection_of(SpinQuantity quantity);

/// What became of one edge.
struct PulseUse {
  Pulse pulse;
  std::optional<std::int64_t> revolution;
  std::optional<Rejection> rejected_by;  ///< Empty: accepted.
  /// What it said to `sequential`, as that decided live; empty where no filter was asked.
  std::optional<Observation> said = {};
};

/// One turn of the body, from one sun1 edge to the next.
struct RevolutionProduct {
  std::int64_t revolution;
  TaiTime t_sun1;
  double period_s;  ///< The clock's, at t_sun1: not this turn's own interval.
};

struct SpinMeasurement {
  std::int64_t revolution;
  SpinQuantity quantity;
  double value;  ///< s for the period, rad otherwise.
  double sigma;  ///< One standard deviation from the stated pulse noise; same unit.
  std::optional<Rejection> rejected_by;
  std::optional<Rational> test = {};  ///< Empty: it was not tested.
};

enum class Resolution { Geometry, Constraint, Prior, Dispersion, Ambiguous };
std::string_view name_of(Resolution resolution);

/// Another axis that the same revolution leaves possible.
struct SpinAlternate {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  /// Tangent plane at this axis: east, north. Zero where it was not kept.
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();
  double misfit = 0.0;  ///< Chi-square of the measurements about it, by the edges' noise.
};

/// Spin axis from one revolution alone.
struct SpinFix {
  std::int64_t revolution;
  TaiTime t;  ///< Its sun1 edge.
  int geometry_case;
  Eigen::Vector3d axis_icrf;
  Eigen::Matrix2d covariance_rad2;        ///< Tangent plane at the axis: east, north.
  std::vector<SpinAlternate> alternates;  ///< The other candidates, best first.
  Resolution resolution;
  double norm;  ///< |P| before normalising: 1 for measurements that agree.
  /// Neither AMBIGUOUS nor from measurements that contradict each other, in this revolution or in
  /// most of the last ones.
  bool accepted;
  /// The candidates lie where they come together and vanish, within the noise: the covariance is
  /// too small, and the true one may be missing.
  bool near_tangent = false;
  double misfit = 0.0;  ///< As of an alternate.
  /// PRIOR, but by the axis that the pass itself has established: what had settled that.
  std::optional<Resolution> settled_before = {};
};
/// As it is said: what the pass itself has established is no prior that anybody gave.
Resolution said_resolution(const SpinFix& fix);

enum class SpinEstimator { Mean, Sequential, Batch };
std::string_view name_of(SpinEstimator estimator);

/// What told the axis of a pass from others: its edges, or, in their order, a resolution of a fix.
enum class SettledBy { Edges, Geometry, Constraint, Prior, Dispersion, Nothing };
std::string_view name_of(SettledBy settled_by);
SettledBy settled_by(Resolution resolution);

/// Which axis a pass has taken, and what else there was.
struct AxisChoice {
  TaiTime t;                ///< Of the estimate that has it.
  SpinEstimator estimator;  ///< Likewise.
  Eigen::Vector3d axis_icrf;
  std::optional<Eigen::Vector3d> other_icrf;  ///< The best other axis; empty: there is none.
  /// By so much the edges fit that worse, a state fitted to them near each: the difference of
  /// PassInformation::misfit(). Empty: only `batch` compares them.
  std::optional<double> delta_chi_square;
  SettledBy settled_by;
};

struct SpinEstimate {
  TaiTime t;
  SpinEstimator estimator;
  Eigen::Vector3d axis_icrf;
  Eigen::Matrix2d covariance_rad2;  ///< Tangent plane at the axis: east, north.
  double spin_rate_rad_s;
  double spin_rate_sigma_rad_s;
  Assessment assessment;
};

using SpinProduct = std::variant<PulseUse, RevolutionProduct, SpinMeasurement, SpinFix,
                                 SpinEstimate, SampleContradiction, AxisChoice>;

}  // namespace spindrift
