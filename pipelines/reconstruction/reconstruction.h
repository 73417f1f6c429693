/// @file
/// The result of a reconstruction: the attitude from separation to the star fixes.

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
#include "pipelines/observation/normal_equations.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class ReconstructionMethod { Batch, Sequential };
constexpr std::string_view name_of(ReconstructionMethod method) {
  return method == ReconstructionMethod::Batch ? "batch" : "sequential";
}

/// The events T1 to T4.
enum class SeparationEvent { Separation, ControlOn, Acquisition, FirstStarFix };
constexpr std::string_view name_of(SeparationEvent event) {
  constexpr std::array<std::string_view, 4> kNames{"T1", "T2", "T3", "T4"};
  return kNames.at(static_cast<std::size_t>(event));
}

/// Holds an attitude; covariances are of small rotations about body axes, q_true = q
/// quaternion_by(error), by noise and by what the mission file may be off by.
struct ReconstructedAttitude {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d rate_body_rad_s;
  Eigen::Matrix3d covariance_rad2;
  Eigen::Matrix3d noise_covariance_rad2;  ///< What would be left if the mission file were exact.
  Eigen::Matrix3d rate_covariance_rad2_s2;

  double sigma_rad() const { return std::sqrt(covariance_rad2.trace()); }  ///< Root of the trace.
  double noise_sigma_rad() const { return std::sqrt(noise_covariance_rad2.trace()); }
};

struct ReconstructedEvent {
  SeparationEvent event;
  bool found;  ///< True if the time was inferred from samples.
  ReconstructedAttitude attitude;
  /// Cramer-Rao bound of the total error about all three axes, with the stated noise and the
  /// priors of bias and mission file; `batch` only.
  std::optional<double> bound_rad = std::nullopt;
};

struct SunMisalignment {
  Eigen::Vector3d vector_rad;  ///< s_measured = quaternion_by(vector) s_body quaternion_by(-vector)
  Eigen::Matrix3d covariance_rad2;
};

/// Holds a direction in which the measurements do not halve the prior uncertainty of the bias.
struct OpenBiasDirection {
  Eigen::Vector3d axis_body;
  double sigma_rad_s;
  double share;                       ///< Sigma over prior sigma.
  std::optional<double> off_sun_rad;  ///< Angle to the line of the last sun vector.
};

struct SensorResiduals {
  std::int64_t count = 0;     ///< Samples used.
  std::int64_t outliers = 0;  ///< Outliers, not included in `count`.
  /// Ratio of the observed noise to the stated one; empty if there are too few samples. For the
  /// gyro it is measured by the scatter about the lines through adjacent samples.
  std::optional<double> noise = std::nullopt;
};

struct Reconstruction {
  ReconstructionMethod method;
  std::vector<ReconstructedEvent> events;  ///< In time order; without T3 if no sun vector shows it.
  std::vector<ReconstructedAttitude> history;  ///< Attitudes from T1 on, in time order.
  std::optional<GyroBias> bias;                ///< Gyro bias, `batch` only.
  std::optional<SunMisalignment> misalignment;
  std::vector<OpenBiasDirection> open_bias;
  SensorResiduals gyro;
  SensorResiduals sun;
  SensorResiduals star;
  /// Observations of all sun vectors and star fixes, used or not, in rad, and of the rejected gyro
  /// samples; in time order per sensor.
  std::vector<Observation> said = {};
  std::optional<NormalEquations> equations = std::nullopt;  ///< `batch` only.
  Assessment assessment;
  int iterations;  ///< Number of Ceres iterations.
};

/// Returns the event; null if the reconstruction lacks it.
inline const ReconstructedEvent* find(const Reconstruction& all, SeparationEvent event) {
  for (const ReconstructedEvent& one : all.events) {
    if (one.event == event) {
      return &one;
    }
  }
  return nullptr;
}

}  // namespace spindrift
