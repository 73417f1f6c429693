/// @file
/// Products of the spin pipeline, to be stored and published in the order they arise.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/observation/observation.h"
#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/spin/types/alignment.h"
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

constexpr SampleSource source_of(SpinQuantity quantity) {
  return static_cast<SampleSource>(index_of(SampleSource::Period) +
                                   static_cast<std::size_t>(quantity));
}

/// Returns the rejection that the test of a quantity gives.
Rejection rejection_of(SpinQuantity quantity);

/// Time between an edge and another, and the least that it must be.
struct EdgeGap {
  double gap_s;
  double least_s;
  friend bool operator==(const EdgeGap&, const EdgeGap&) = default;
};

/// What became of one edge.
struct PulseUse {
  Pulse pulse;
  std::optional<std::int64_t> revolution;
  std::optional<Rejection> rejected_by;  ///< Empty: accepted.
  /// Observation that the edge gave to `sequential`, as decided live, or to the clock of turns that
  /// rejected it; empty where neither was asked.
  std::optional<Observation> said = {};
  /// The gap to an edge of another channel that interferes, or to the edge of its channel that
  /// counts.
  std::optional<EdgeGap> gap = {};
};

/// One turn of the body, from one sun1 edge to the next.
struct RevolutionProduct {
  std::int64_t revolution;
  TaiTime t_sun1;
  double period_s;  ///< Period of the clock at t_sun1, not this turn's own interval.
};

struct SpinMeasurement {
  std::int64_t revolution;
  SpinQuantity quantity;
  double value;  ///< s for the period, rad otherwise.
  double sigma;  ///< One standard deviation from the stated pulse noise; same unit.
  std::optional<Rejection> rejected_by;
  std::optional<Observation> said = {};  ///< Empty: it was not tested.
};

enum class Resolution { Geometry, Constraint, Prior, Dispersion, Ambiguous };
std::string_view name_of(Resolution resolution);

/// Another axis that the same revolution leaves possible.
struct SpinAlternate {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  /// Total covariance in the tangent plane at this axis (east, north); zero where it was not kept.
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();
  /// Chi-square of the measurements about the axis, by the noise of the edges and the alignment.
  double misfit = 0.0;
  /// Part of the covariance that errors of the mission file make.
  Eigen::Matrix2d alignment_rad2 = Eigen::Matrix2d::Zero();
};

/// Spin axis from one revolution alone.
struct SpinFix {
  std::int64_t revolution;
  TaiTime t;  ///< Time of its sun1 edge.
  int geometry_case;
  Eigen::Vector3d axis_icrf;
  Eigen::Matrix2d covariance_rad2;        ///< Total, tangent plane at the axis: east, north.
  std::vector<SpinAlternate> alternates;  ///< The other candidates, best first.
  Resolution resolution;
  double norm;  ///< |P| before normalising: 1 for measurements that agree.
  /// Whether the fix is neither AMBIGUOUS nor from measurements that contradict each other, in this
  /// revolution or in most of the last ones.
  bool accepted;
  /// Whether the candidates lie, within the noise, where they merge and vanish: the covariance is
  /// then too small, and the true candidate may be missing.
  bool near_tangent = false;
  double misfit = 0.0;  ///< Chi-square as in SpinAlternate.
  /// Part of the covariance that errors of the mission file make.
  Eigen::Matrix2d alignment_rad2 = Eigen::Matrix2d::Zero();
  /// For a PRIOR fix by an axis that the pass has established: what had settled that axis.
  std::optional<Resolution> settled_before = {};
};
/// Returns the resolution to report: an axis that the pass has established is no given prior.
Resolution said_resolution(const SpinFix& fix);

enum class SpinEstimator { Mean, Sequential, Batch };
std::string_view name_of(SpinEstimator estimator);

/// What told the axis of a pass from others: its edges, or a resolution in the order of Resolution.
enum class SettledBy { Edges, Geometry, Constraint, Prior, Dispersion, Nothing };
std::string_view name_of(SettledBy settled_by);
SettledBy settled_by(Resolution resolution);

/// True axis minus that of an estimate per error of the mission file, each error as independent
/// ones of unit variance (root_of()), rad, ICRF. Errors of several estimators in one pass are the
/// same.
using AxisShift = Eigen::Matrix<double, 3, kSpinAlignmentErrors>;
struct EstimatorShift {
  SpinEstimator estimator;
  AxisShift shift_icrf;
};

/// The axis that a pass has taken, and the best other one.
struct AxisChoice {
  TaiTime t;  ///< Time of the estimate with this axis.
  SpinEstimator estimator;
  Eigen::Vector3d axis_icrf;
  std::optional<Eigen::Vector3d> other_icrf;  ///< The best other axis; empty: there is none.
  /// How much worse the edges fit the other axis, with a state fitted near each: the difference of
  /// PassInformation::misfit(). Empty unless `batch`, which alone compares them.
  std::optional<double> delta_chi_square;
  SettledBy settled_by;
  std::vector<EstimatorShift> shifts = {};  ///< Shifts of all answers at `t`.
};

struct SpinEstimate {
  TaiTime t;
  SpinEstimator estimator;
  Eigen::Vector3d axis_icrf;
  Eigen::Matrix2d covariance_rad2;  ///< Total, tangent plane at the axis: east, north.
  double spin_rate_rad_s;
  double spin_rate_sigma_rad_s;
  Assessment assessment;
  /// Part of the covariance that errors of the mission file make.
  Eigen::Matrix2d alignment_rad2 = Eigen::Matrix2d::Zero();
  std::optional<AxisShift> shift_icrf = {};  ///< Empty where `alignment_rad2` alone is known.
};

/// Returns one standard deviation of the angle between the axes of two estimates of one pass. Of
/// noise that is the larger of the two, since estimators of the same edges differ by no more than
/// the worse of them errs; errors of the mission file are the same for both.
double difference_sigma_rad(const SpinEstimate& one, const SpinEstimate& other);

/// Returns what the sigma of a fix or an estimate would be if the mission file were exact.
template <class Axis>
double noise_sigma_rad(const Axis& axis) {
  return std::sqrt(std::max((axis.covariance_rad2 - axis.alignment_rad2).trace(), 0.0));
}

using SpinProduct = std::variant<PulseUse, RevolutionProduct, SpinMeasurement, SpinFix,
                                 SpinEstimate, SampleContradiction, AxisChoice, SensorsCompared>;

/// An axis that is known beforehand, or from what the pass has shown so far.
struct KnownAxis {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double sigma_rad;
  /// States what separated this axis from the other candidates. A fix that is chosen by this axis
  /// takes it over. Edges count as Dispersion, because over many turns only one axis fits them.
  Resolution settled_by = Resolution::Dispersion;
};

}  // namespace spindrift
