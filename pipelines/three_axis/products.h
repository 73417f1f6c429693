/// @file
/// What the three-axis pipeline gives: values to be stored and published, in the order they arise.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "pipelines/core/assessment.h"
#include "pipelines/time/sample_contradiction.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// At one instant they are taken in in this order.
enum class SampleKind { OrbitState, Gyro, Star, Sun, Magnetometer };
inline constexpr std::size_t kSampleKinds = 5;
constexpr std::size_t index_of(SampleKind kind) { return static_cast<std::size_t>(kind); }
std::string_view name_of(SampleKind kind);

/// Why a sample was left out.
enum class SampleRejection {
  Late,          ///< Arrived after its time had been processed.
  OutOfTime,     ///< Far from all others in time, by a clock that nothing else agrees with.
  Contradicted,  ///< It came with another value, too, and nobody is preferred.
  NoSensor,      ///< The mission file has no such sensor.
  Operator,      ///< An operator has left it out.
  Saturated,     ///< Of the gyro: beyond its range.
  Frozen,        ///< The same numbers as too many before it.
  Outlier,       ///< Of the gyro: off from its neighbours.
  Shadow,        ///< Of the sun sensor: the Earth is before the Sun.
  NoOrbit,       ///< Of an orbit state: on no ellipse round the Earth. Of a field: unknown where.
  NoField,       ///< Of the magnetometer: the model of the field does not reach.
  Unit,          ///< Of the gyro: its rates are in another unit, by the star fixes.
  Innovation,    ///< Too far from where the attitude has it; of a field: or from its strength.
};
std::string_view name_of(SampleRejection rejection);

struct RejectedSample {
  TaiTime t;
  SampleKind kind;
  SampleRejection rejected_by;
  std::optional<double> squared_innovation = {};  ///< Normalised; of Innovation.
  std::optional<double> rate_rad_s = {};          ///< Of the gyro: the largest.
};

/// The record of one sensor in a pass.
struct SensorHealth {
  std::int64_t accepted = 0;
  std::int64_t rejected = 0;
  std::int64_t rejected_in_a_row = 0;  ///< Up to now.
  std::optional<TaiTime> last_seen;    ///< The youngest sample, accepted or not.
};
using SensorHealths = std::array<SensorHealth, kSampleKinds>;  ///< By kind.

/// What made an attitude: the filter, or a reconstruction of the separation.
enum class AttitudeSource { Mekf, Batch, Sequential };
std::string_view name_of(AttitudeSource source);

/// Of the samples that the filter accepted, what they differed from where it had them.
struct Innovations {
  double squared = 0.0;      ///< Normalised, their sum: a chi-square when all is well.
  std::int64_t freedom = 0;  ///< Of so many degrees of freedom.
};

/// What the gyro says more than the body turns, body axes.
struct GyroBias {
  Eigen::Vector3d rad_s;
  Eigen::Matrix3d covariance_rad2_s2;
};

struct AttitudeEstimate {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
  std::optional<Eigen::Vector3d> rate_body_rad_s;  ///< Less the bias; empty: no gyro at `t`.
  Eigen::Matrix3d covariance_rad2;                 ///< Of a small turn, body axes.
  Assessment assessment;
  AttitudeSource source = AttitudeSource::Mekf;
  Innovations innovations = {};            ///< Since the estimate before.
  std::optional<GyroBias> gyro_bias = {};  ///< At most once a second.

  double sigma_rad() const;  ///< Root of the trace.
};

using ThreeAxisProduct = std::variant<RejectedSample, AttitudeEstimate, SampleContradiction>;

}  // namespace spindrift
