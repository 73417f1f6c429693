/// @file
/// Interpolates the rate between gyro samples and integrates the turn between two instants.
///
/// The rate is linear between samples. Each sample has independent noise and affects both adjacent
/// steps, so that their turns correlate. Turns are returned as uncorrelated, with half the
/// covariance between neighbours added to each. The variance over many steps is then right except
/// at the ends, and that of a single step is up to twice too large.
///
/// A step longer than 1.75 times the usual one is a gap. The rate may have jumped at any instant in
/// it from the earlier to the later value: a turn of |dw| h / sqrt(12) along the change. It may
/// also have changed and changed back: a random walk as strong as in the adjacent seconds
/// (rate_wander.h), tied at both ends, which gives h^3 / 12 times its density, or h^3 / 3 behind
/// the last sample, where it is free at one end. Before the first sample, whose error grows over
/// the whole arc to T1, the rate may also have changed about each axis as much as in the equally
/// long stretch that follows, because thrusters fire for a while.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/reconstruction/shared_errors.h"

namespace spindrift {

struct TimedRate {
  double t_s;
  Eigen::Vector3d rate_body_rad_s;
};

/// Holds the turn from one instant to a later one: q_later = q_earlier turn.
struct Turn {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  /// Derivative with respect to the bias: turn(bias + db) = turn quaternion_by(J db) for small db.
  Eigen::Matrix3d per_bias_s = Eigen::Matrix3d::Zero();
  /// Derivative with respect to the gyro's scale and axis errors, likewise; to second order in the
  /// steps of the samples.
  PerGyroError per_gyro_error = PerGyroError::Zero();
  /// Covariance of small rotations about body axes at the later instant, rad^2.
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();

  /// Returns both derivatives.
  PerTurnError per_error() const;
};

class RateTrack {
 public:
  RateTrack() = default;  ///< Empty track, to be assigned.
  /// Builds a track in which the first and last rates are held out to `begin_s` and `end_s`.
  /// @param samples At least one, in strictly rising time order.
  RateTrack(std::vector<TimedRate> samples, double begin_s, double end_s, double noise_rad_s);

  /// Returns the measured rate, bias included.
  Eigen::Vector3d rate_at(double t_s) const;

  /// Returns the turn between each two consecutive instants, corrected for the bias.
  /// @param times_s Rising times within the track.
  std::vector<Turn> turns(std::span<const double> times_s, const Eigen::Vector3d& bias_rad_s) const;

  /// Returns the measured rates, including the held ones at both ends.
  std::span<const TimedRate> samples() const { return samples_; }
  std::int64_t gaps() const { return gaps_; }
  double longest_gap_s() const { return longest_gap_s_; }
  /// Returns the variance per axis of the first rate from having been held back to the beginning.
  double start_variance_rad2_s2() const { return start_variance_rad2_s2_; }
  bool is_gap(std::size_t step) const { return !steps_[step].gap_rad2.isZero(0.0); }

 private:
  struct Step {
    double noise_rad2_s;       ///< Variance per axis and second.
    Eigen::Matrix3d gap_rad2;  ///< Additional covariance of the whole step.
  };
  std::size_t step_at(double t_s) const;
  void append(Turn& turn, std::size_t step, double from_s, double to_s,
              const Eigen::Vector3d& bias_rad_s) const;
  Eigen::Vector3d rate_in(std::size_t step, double t_s) const;

  std::vector<TimedRate> samples_;
  std::vector<Step> steps_;
  std::int64_t gaps_ = 0;
  double longest_gap_s_ = 0.0;
  double start_variance_rad2_s2_ = 0.0;
};

/// Returns the median step; 0 for fewer than two samples.
double usual_step_s(std::span<const TimedRate> samples);

}  // namespace spindrift
