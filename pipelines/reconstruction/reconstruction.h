/// @file
/// The attitude from separation to the star fixes, as reconstructed.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class ReconstructionMethod { Batch, Sequential };
/// "batch", "sequential".
constexpr std::string_view name_of(ReconstructionMethod method) {
  return method == ReconstructionMethod::Batch ? "batch" : "sequential";
}

/// T1 to T4.
enum class SeparationEvent { Separation, ControlOn, Acquisition, FirstStarFix };
/// "T1" to "T4".
constexpr std::string_view name_of(SeparationEvent event) {
  constexpr std::array<std::string_view, 4> kNames{"T1", "T2", "T3", "T4"};
  return kNames.at(static_cast<std::size_t>(event));
}

/// Covariances are of small rotations about body axes: q_true = q quaternion_by(error).
struct ReconstructedAttitude {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d rate_body_rad_s;
  Eigen::Matrix3d covariance_rad2;
  Eigen::Matrix3d rate_covariance_rad2_s2;

  double sigma_rad() const { return std::sqrt(covariance_rad2.trace()); }  ///< Of all three axes.
};

struct ReconstructedEvent {
  SeparationEvent event;
  bool found;  ///< In the samples, as nobody named its time.
  ReconstructedAttitude attitude;
  /// Of `batch`. Cramer-Rao bound of the error about all three axes together, with the noise as
  /// stated and the priors.
  std::optional<double> bound_rad = std::nullopt;
};

struct SunMisalignment {
  Eigen::Vector3d vector_rad;  ///< s_measured = quaternion_by(vector) s_body quaternion_by(-vector)
  Eigen::Matrix3d covariance_rad2;
};

/// A direction in which the measurements do not halve what is known of the bias beforehand.
struct OpenBiasDirection {
  Eigen::Vector3d axis_body;
  double sigma_rad_s;
  double share;                       ///< Of that known beforehand.
  std::optional<double> off_sun_rad;  ///< Its angle to the Sun line of the last sun vector.
};

struct SensorResiduals {
  std::int64_t count = 0;     ///< Used.
  std::int64_t outliers = 0;  ///< Not among these.
  /// How many times the stated noise is in them. Of the gyro from how its samples scatter about the
  /// lines through their neighbours. Empty where there are too few.
  std::optional<double> noise = std::nullopt;
};

struct Reconstruction {
  ReconstructionMethod method;
  std::vector<ReconstructedEvent> events;      ///< In order; no T3 where no sun vector shows it.
  std::vector<ReconstructedAttitude> history;  ///< From T1, in order.
  std::optional<GyroBias> bias;                ///< Of `batch`.
  std::optional<SunMisalignment> misalignment;
  std::vector<OpenBiasDirection> open_bias;
  SensorResiduals gyro;
  SensorResiduals sun;
  SensorResiduals star;
  /// What sun vectors and star fixes said, used or not, in rad, and the gyro samples that were left
  /// out; each sensor in order of time.
  std::vector<Observation> said = {};
  Assessment assessment;
  int iterations;  ///< Of Ceres.
};

/// Null where it has none.
inline const ReconstructedEvent* find(const Reconstruction& all, SeparationEvent event) {
  for (const ReconstructedEvent& one : all.events) {
    if (one.event == event) {
      return &one;
    }
  }
  return nullptr;
}

}  // namespace spindrift
