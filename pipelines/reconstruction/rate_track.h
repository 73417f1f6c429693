/// @file
/// The rate between gyro samples, and what the body turned by from one instant to another.
///
/// The rate is linear between samples. Each sample has independent noise and belongs to the two
/// steps beside it, whose turns therefore correlate. Turns are given as if they did not, with the
/// covariance between neighbours added to both, half each: the variance over any number of steps
/// is right but for its ends, that of a lone step up to twice too large.
///
/// A step of more than 1.75 times the usual one is a gap. The rate may have changed at once, at any
/// instant of it, from what it was before to what it was behind: a turn of |dw| h / sqrt(12), along
/// the change. It may also have changed and changed back: a random walk as strong as in the seconds
/// beside (rate_wander.h), tied at both ends, h^3 / 12 times its density; behind the last sample,
/// where nothing ties it, h^3 / 3. Before the first sample, whose error grows by the whole arc to
/// T1, it may besides have changed about each axis as much as in the equally long stretch behind:
/// thrusters are on for a while.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace spindrift {

struct TimedRate {
  double t_s;
  Eigen::Vector3d rate_body_rad_s;
};

/// From one instant to another: q_later = q_earlier turn.
struct Turn {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  /// turn(bias + db) = turn quaternion_by(J db), exact for small db.
  Eigen::Matrix3d per_bias_s = Eigen::Matrix3d::Zero();
  /// Of small rotations about body axes at the later instant, rad^2.
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();
};

class RateTrack {
 public:
  RateTrack() = default;  ///< Empty, to be assigned.
  /// Holds the first and the last rate out to `begin_s` and `end_s`.
  /// @param samples At least one; times rise.
  RateTrack(std::vector<TimedRate> samples, double begin_s, double end_s, double noise_rad_s);

  /// Bias included.
  Eigen::Vector3d rate_at(double t_s) const;

  /// Between each two of these instants that are neighbours, with a bias taken off.
  /// @param times_s They rise, within the track.
  std::vector<Turn> turns(std::span<const double> times_s, const Eigen::Vector3d& bias_rad_s) const;

  /// As measured. Held rates at both ends included.
  std::span<const TimedRate> samples() const { return samples_; }
  std::int64_t gaps() const { return gaps_; }
  double longest_gap_s() const { return longest_gap_s_; }
  /// Per axis, of the first rate, that it was held to the beginning.
  double start_variance_rad2_s2() const { return start_variance_rad2_s2_; }
  bool is_gap(std::size_t step) const { return !steps_[step].gap_rad2.isZero(0.0); }

 private:
  struct Step {
    double noise_rad2_s;       ///< Variance per axis and second.
    Eigen::Matrix3d gap_rad2;  ///< Of the whole step, besides.
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

/// Median of the steps; 0 of fewer than two samples.
double usual_step_s(std::span<const TimedRate> samples);

}  // namespace spindrift
