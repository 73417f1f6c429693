/// @file
/// A request checked and put in order: everything on seconds since T2 and in body axes.

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
  TaiTime origin;                 ///< T2
  std::vector<EventTime> events;  ///< In order; no T3 where no sun vector shows it.
  RateTrack rates;                ///< From T2 to the end.
  std::vector<SunObservation> sun = {};
  std::vector<StarObservation> stars = {};
  /// Of what is solved for: T4, or the last star fix behind it that is used.
  double end_s = 0.0;
  double gyro_noise_rad_s = 0.0;  ///< That of the samples, where it is more than stated.
  std::optional<double> gyro_noise = std::nullopt;  ///< Over the stated one.
  std::int64_t gyro_samples = 0;
  std::vector<RejectedSample> gyro_left_out = {};
  bool first_is_outlier = false;    ///< Of those one is the first behind T2.
  std::int64_t in_shadow = 0;       ///< Sun vectors while the Earth hid the Sun, left out.
  std::int64_t shadow_unknown = 0;  ///< Sun vectors that the orbit does not cover.

  double seconds_of(TaiTime t) const { return seconds_between(origin, t); }
  std::int64_t gyro_left_out_by(Rejection test) const;
};

/// What a sun vector says: about two axes across it.
/// @param covariance Of measured minus expected, which is `off`.
Observation sun_observation(const Observations& all, const SunObservation& sun,
                            const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance);

/// So long behind T4 star fixes are used. The bias of the gyro is one value, and that of later is
/// another: with 0.005 deg/s an hour ten minutes move T1 beyond its sigma, two do not, and where it
/// is constant they know T1 to within 5 % of what ten do.
inline constexpr double kUsedBehindFirstFix_s = 120.0;

SensorResiduals gyro_residuals(const Observations& all);
void add_gyro_left_out(const Observations& all, std::vector<Observation>& said);

/// So far beyond gyro samples, in order of time, an event or a star fix may lie: the next sample
/// was on its way.
double held_s(std::span<const GyroSample> gyro);

/// @return As reconstruct().
Expected<Observations> observations_of(const ReconstructionRequest& request);

}  // namespace spindrift
