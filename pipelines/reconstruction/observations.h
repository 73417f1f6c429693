/// @file
/// Validates a request and prepares its samples: sorted, in seconds since T2 and in body axes.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/observation/observation.h"
#include "pipelines/reconstruction/event_times.h"
#include "pipelines/reconstruction/rate_track.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

struct SunObservation {
  double t_s;
  Eigen::Vector3d measured_body;
  Eigen::Vector3d sun_icrf;
};

struct StarObservation {
  double t_s;
  Eigen::Quaterniond q_icrf_body;
};

struct Observations {
  TaiTime origin;                 ///< Epoch T2.
  std::vector<EventTime> events;  ///< Events in time order; T3 is absent if no sun vector shows it.
  RateTrack rates;                ///< Rates from T2 to `end_s`.
  std::vector<SunObservation> sun = {};
  std::vector<StarObservation> stars = {};
  /// End of the solved span: T4, or the last used star fix after it.
  double end_s = 0.0;
  double gyro_noise_rad_s = 0.0;  ///< Noise as stated, or that of the samples if larger.
  std::optional<double> gyro_noise = std::nullopt;  ///< Sample noise over stated; empty: unknown.
  std::int64_t gyro_samples = 0;
  std::vector<RejectedSample> gyro_left_out = {};
  bool first_is_outlier = false;    ///< The first gyro sample after T2 is an outlier.
  std::int64_t in_shadow = 0;       ///< Sun vectors rejected because the Sun was eclipsed.
  std::int64_t shadow_unknown = 0;  ///< Sun vectors at times that the orbit does not cover.

  double seconds_of(TaiTime t) const { return seconds_between(origin, t); }
  std::int64_t gyro_left_out_by(Rejection test) const;
};

/// Returns the observation of a sun vector, with residuals about two axes across it.
/// @param off Measured minus expected vector.
/// @param covariance Covariance of `off`.
Observation sun_observation(const Observations& all, const SunObservation& sun,
                            const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance);

/// Time after T4 up to which star fixes are used. The bias is modelled as constant, although it
/// drifts: at 0.005 deg/s per hour, ten minutes of fixes move T1 beyond its sigma and two minutes
/// do not, and with a constant bias two minutes determine T1 to within 5 % of ten.
inline constexpr double kUsedBehindFirstFix_s = 120.0;

SensorResiduals gyro_residuals(const Observations& all);
void add_gyro_left_out(const Observations& all, std::vector<Observation>& said);

/// Returns how far, in s, an event or star fix may lie outside the gyro samples: two usual steps,
/// to allow for a sample that was still due. The samples must be in time order.
double held_s(std::span<const GyroSample> gyro);

/// @return Errors as listed at reconstruct().
Expected<Observations> observations_of(const ReconstructionRequest& request);

}  // namespace spindrift
