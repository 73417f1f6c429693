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
#include "pipelines/observation/observation.h"
#include "pipelines/time/sample_contradiction.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// At one instant they are taken in in this order.
enum class SampleKind { OrbitState, Gyro, Star, Sun, Magnetometer };
inline constexpr std::size_t kSampleKinds = 5;
constexpr std::size_t index_of(SampleKind kind) { return static_cast<std::size_t>(kind); }
std::string_view name_of(SampleKind kind);
constexpr SampleSource source_of(SampleKind kind) {
  return static_cast<SampleSource>(index_of(SampleSource::OrbitState) + index_of(kind));
}
/// @param source Of a sample of a three-axis spacecraft.
constexpr SampleKind kind_of(SampleSource source) {
  return static_cast<SampleKind>(index_of(source) - index_of(SampleSource::OrbitState));
}

/// What failed a test, and what it was held against: of Innovation the normalised square, of
/// Saturated and Outlier rad/s, of Frozen how many samples repeat, of Unit how many times too large
/// the rates are.
struct FailedTest {
  double value;
  double limit;
};

struct RejectedSample {
  TaiTime t;
  SampleKind kind;
  Rejection rejected_by;
  std::optional<FailedTest> failed = {};  ///< Empty: the test has no number.
};

/// Of the gyro, which no estimator expects: its residual is what the test found.
Observation observation_of(const RejectedSample& gyro);

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

/// What a sample said to the filter, or to a reconstruction.
struct SampleObservation {
  AttitudeSource estimator;
  Observation said;
};

using ThreeAxisProduct =
    std::variant<RejectedSample, AttitudeEstimate, SampleObservation, SampleContradiction>;

}  // namespace spindrift
