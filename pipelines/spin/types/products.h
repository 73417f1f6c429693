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

/// Why an edge or a measurement was left out.
enum class Rejection {
  Unassociated,  ///< No revolution had a place for the edge.
  Late,          ///< Arrived after its time had been processed.
  OutOfTime,     ///< Far from all others in time, by a clock that nothing else agrees with.
  Contradicted,  ///< Of a coded frame that came with other values, too, and nobody is preferred.
  Copy,          ///< Its channel's edges come several times: another counts, or it came alone.
  Interference,  ///< An edge of another channel is so near that both are spoilt.
  Operator,      ///< An operator has left it out.
  Phase,     ///< Not where the edges of its channel lie; of a measurement: rests on such an edge.
  Geometry,  ///< The measurement has no meaning (chord of a whole turn, slit lag out of range).
  NoSensor,  ///< The mission file has no such sensor.
  NoOrbit,   ///< The orbit does not cover it: not testable.
  Period,    ///< Failed the spin-period test.
  SunAngle,  ///< Failed the 3-sigma test of that quantity; likewise the following.
  NorthChord,
  SouthChord,
  NorthDihedral,
  SouthDihedral,
  MixedAzimuth,
};
std::string_view name_of(Rejection rejection);
Rejection rejection_of(SpinQuantity quantity);

/// What became of one edge.
struct PulseUse {
  Pulse pulse;
  std::optional<std::int64_t> revolution;
  std::optional<Rejection> rejected_by;  ///< Empty: accepted.
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
};

enum class Resolution { Geometry, Constraint, Prior, Dispersion, Ambiguous };
std::string_view name_of(Resolution resolution);

/// Another axis that the same revolution leaves possible.
struct SpinAlternate {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  /// Tangent plane at this axis: east, north. Zero where it was not kept.
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();
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
};

enum class SpinEstimator { Mean, Sequential, Batch };
std::string_view name_of(SpinEstimator estimator);

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
                                 SpinEstimate, SampleContradiction>;

}  // namespace spindrift
