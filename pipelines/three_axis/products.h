/// @file
/// The results of the three-axis pipeline, to be stored and published in order of computation.

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
#include "pipelines/observation/gate.h"
#include "pipelines/observation/normal_equations.h"
#include "pipelines/observation/observation.h"
#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/time/sample_contradiction.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Samples of one instant are processed in the order of this enumeration.
enum class SampleKind { OrbitState, Gyro, Star, Sun, Magnetometer };
inline constexpr std::size_t kSampleKinds = 5;
constexpr std::size_t index_of(SampleKind kind) { return static_cast<std::size_t>(kind); }
std::string_view name_of(SampleKind kind);
constexpr SampleSource source_of(SampleKind kind) {
  return static_cast<SampleSource>(index_of(SampleSource::OrbitState) + index_of(kind));
}
/// @param source A source that belongs to a three-axis spacecraft.
constexpr SampleKind kind_of(SampleSource source) {
  return static_cast<SampleKind>(index_of(source) - index_of(SampleSource::OrbitState));
}

/// Holds the tested value and its limit. Innovation: normalised square. Saturated and Outlier:
/// rad/s. Frozen: number of repeats. Unit: factor by which the rates are too large.
struct FailedTest {
  double value;
  double limit;
};

struct RejectedSample {
  TaiTime t;
  SampleKind kind;
  Rejection rejected_by;
  std::optional<FailedTest> failed = {};  ///< Empty if the test has no number.
};

/// Converts a rejected gyro sample, which no estimator predicts; the residual is the tested value.
Observation observation_of(const RejectedSample& gyro);

/// Holds the counts of one sensor in a pass.
struct SensorHealth {
  std::int64_t accepted = 0;
  std::int64_t rejected = 0;
  std::int64_t rejected_in_a_row = 0;  ///< Current run of rejections.
  std::optional<TaiTime> last_seen;    ///< Time of the newest sample, accepted or not.
};
using SensorHealths = std::array<SensorHealth, kSampleKinds>;  ///< Indexed by SampleKind.

/// The estimator that made an attitude: the filter, or a reconstruction of the separation.
enum class AttitudeSource { Mekf, Batch, Sequential };
std::string_view name_of(AttitudeSource source);

/// Accumulates the normalised innovations of the samples that the filter accepted.
struct Innovations {
  double squared = 0.0;      ///< Sum of NIS; chi-square distributed if the filter is consistent.
  std::int64_t freedom = 0;  ///< Degrees of freedom of `squared`.
};

/// Holds the gyro bias, measured minus true rate, body axes.
struct GyroBias {
  Eigen::Vector3d rad_s;
  Eigen::Matrix3d covariance_rad2_s2;
};

struct AttitudeEstimate {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
  std::optional<Eigen::Vector3d> rate_body_rad_s;  ///< Bias removed; empty without gyro at `t`.
  Eigen::Matrix3d covariance_rad2;                 ///< Covariance of a small turn, body axes.
  /// What `sigma_rad()` would be if the mission file were exact.
  double noise_sigma_rad = 0.0;
  Assessment assessment;
  AttitudeSource source = AttitudeSource::Mekf;
  Innovations innovations = {};            ///< Innovations since the previous estimate.
  std::optional<GyroBias> gyro_bias = {};  ///< Present at most once a second.
  /// Contradiction of the sensors up to `t`, whether it casts doubt on this attitude or not.
  std::optional<SensorContradiction> contradiction = {};

  double sigma_rad() const;  ///< Root of the trace of the covariance.
};

/// Holds the observation that a sample gave to the filter or to a reconstruction.
struct SampleObservation {
  AttitudeSource estimator;
  Observation said;
};

/// What a sensor of a lost body still gives.
enum class SensorVoice {
  Speaks,
  LeftOut,  ///< It speaks, and all of its last samples were left out.
  Silent,
  Never,  ///< It has not spoken in this pass.
};
inline constexpr int kSensorVoices = 4;
constexpr std::string_view name_of(SensorVoice voice) {
  constexpr std::array<std::string_view, kSensorVoices> kNames = {"speaks", "left_out", "silent",
                                                                  "never"};
  return kNames.at(static_cast<std::size_t>(voice));
}
/// Indexed by SampleKind; empty where there is no such sensor on board.
using SensorVoices = std::array<std::optional<SensorVoice>, kSampleKinds>;

/// What is known of a body that is lost.
struct Advisory {
  TaiTime t = {};
  SensorVoices sensors = {};
  std::optional<AttitudeEstimate> attitude = {};  ///< The last one, if it is not too old.
  double off_deg = 0.0;      ///< Angle of the field to that expected at the nominal attitude.
  bool certain = false;      ///< The Sun says the same.
  bool may_control = false;  ///< The safe gate is open.
};

using ThreeAxisProduct =
    std::variant<RejectedSample, AttitudeEstimate, SampleObservation, SampleContradiction,
                 NormalEquations, SensorsCompared, GateTransition, Advisory>;

}  // namespace spindrift
