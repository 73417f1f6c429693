/// @file
/// This file tests whether two sensors contradict each other, by what they have said recently.
///
/// Each comparison gives a small turn, by which the second sensor says otherwise than the first.
/// The comparisons of the last seconds are averaged. The average is held against its total
/// covariance: of noise, and of what the errors of the mission file may do, which do not average
/// out. A single comparison that is far off has little weight in it. Several in a row that are far
/// off each by itself are a contradiction, too, whichever way each points: what a gyro of a wrong
/// sign says of a body that turns to and fro averages out.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/three_axis/sensor_errors.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// First index of the errors that act on a pair of sensors and last for a pass, behind those of the
/// mission file.
enum PairError {
  GyroBiasError = kFilterErrors,        ///< rad/s, body axes.
  FieldModelError = kFilterErrors + 3,  ///< Field beyond the model, by its strength, body axes.
};
inline constexpr int kPairErrors = kFilterErrors + 6;

/// Derivative of a turn by the errors, body axes.
using TurnPerPairError = Eigen::Matrix<double, 3, kPairErrors>;
using PairPrior = Eigen::Matrix<double, kPairErrors, kPairErrors>;

/// Returns a normalised square with these degrees of freedom as a number of sigma of one component.
double sigmas_from(double square, int freedom);

/// One comparison of two sensors.
struct PairComparison {
  Eigen::Vector3d turn_rad;     ///< Difference, body axes. Of a gyro it is the turn in a second.
  Eigen::Matrix3d information;  ///< Of the noise; zero about axes that the pair does not measure.
  int freedom;                  ///< Number of axes that it measures.
  TurnPerPairError per_error;
};

class SensorPair {
 public:
  /// Time constant by which comparisons are forgotten.
  static constexpr double kRecent_s = 12.0;
  /// Number of sigma from which two sensors contradict each other.
  static constexpr double kContradicts = 5.0;
  /// Number of sigma up to which they agree.
  static constexpr double kAgrees = 3.5;

  /// @param prior Covariance of the errors.
  void add(TaiTime t, const PairComparison& compared, const PairPrior& prior);

  /// Returns whether the sensors have been compared often enough, and lately.
  bool is_tested(TaiTime now) const;
  /// Returns the difference over its total standard deviation, as if it had one component.
  double sigmas() const { return sigmas_; }
  /// Returns whether the sensors have contradicted each other lately.
  bool contradicts(TaiTime now) const;
  bool agrees(TaiTime now) const { return is_tested(now) && sigmas_ <= kAgrees; }
  /// Returns the difference, least about axes that the pair does not measure.
  const Eigen::Vector3d& turn_rad() const { return turn_rad_; }
  /// Returns the mean difference, which is less where it changes its sign: of the last comparisons
  /// if these show the same beyond doubt, else of all.
  Eigen::Vector3d lasting_turn_rad() const;
  /// Returns for how long the comparisons have shown that difference.
  double lasting_s() const;
  /// Returns the inverse of the total covariance of the mean difference, 1/rad^2.
  Eigen::Matrix3d weight(const PairPrior& prior) const;
  /// Returns how many sigma this pair would be off if its sensor were turned by what another pair
  /// shows.
  /// @param known Inverse covariance of the turn, 1/rad^2.
  double sigmas_if(const Eigen::Vector3d& turn_rad, const Eigen::Matrix3d& known,
                   const PairPrior& prior) const;

 private:
  void forget(TaiTime t);
  void see_steady(TaiTime t, const Eigen::Vector3d& turn_rad, double alone);
  bool is_steady() const;
  Eigen::Vector3d mean_turn_rad() const;
  double sigmas_alone(const PairComparison& compared, const PairPrior& prior) const;
  void judge(const PairPrior& prior);
  Eigen::Matrix3d noise_covariance() const;
  Eigen::Matrix3d covariance(const PairPrior& prior) const;

  std::optional<TaiTime> last_;
  int count_ = 0;
  int freedom_ = 0;  ///< Freedom of the last comparison.
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d score_ = Eigen::Vector3d::Zero();
  TurnPerPairError per_error_ = TurnPerPairError::Zero();  ///< Derivative of `score_`.
  Eigen::Matrix3d noise_ = Eigen::Matrix3d::Zero();        ///< Covariance of `score_` by noise.
  double weighted_squares_ = 0.0;  ///< Sum of normalised squares, by the weight in the mean.
  double weighted_freedoms_ = 0.0;
  double squares_ = 0.0;         ///< Sum of normalised squares, each bounded.
  double freedoms_ = 0.0;        ///< Expected value of `squares_`.
  int far_in_a_row_ = 0;         ///< Number of last comparisons each far off by itself.
  int near_in_a_row_ = 0;        ///< Number of last comparisons that agree.
  double least_in_a_row_ = 0.0;  ///< The least of those far off, sigma.
  int steady_ = 0;  ///< Number of last comparisons that show the same turn beyond doubt.
  TaiTime steady_since_ = {};
  Eigen::Vector3d steady_turn_rad_ = Eigen::Vector3d::Zero();  ///< Mean of these.
  double sigmas_ = 0.0;
  Eigen::Vector3d turn_rad_ = Eigen::Vector3d::Zero();
  std::optional<TaiTime> contradicted_;  ///< Last time of a contradiction.
};

}  // namespace spindrift
