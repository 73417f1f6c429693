/// @file
/// Estimates attitude and gyro bias from samples in time order with a Kalman filter (mekf.h). It
/// initialises the filter, gates the samples, assesses the quality of the estimate and
/// reinitialises after a loss of attitude.
///
/// The filter begins at a star fix, or at two directions that agree (carried_directions.h); no
/// estimate exists before that, but contradictions of the sensors are told. A star fix or direction
/// between two gyro samples waits for the second of them, because the rate is interpolated linearly
/// in between. If no gyro sample follows, the last rate is held and the covariance grows by the
/// observed variability of the rate. Without any gyro, two directions within one second give the
/// attitude of that instant, as a star fix does. An attitude is LOST when all sensors reject it, or
/// when its standard deviation exceeds 1 rad for lack of measurements. The filter then begins again
/// at the next fix.
///
/// Samples that repeat bit for bit are left out (frozen_samples.h). Star fixes that the attitude
/// rejects but that agree with each other form a rival attitude. Sun and
/// magnetic field decide between the two. Where they do not decide, the star fixes win in the end,
/// and the estimate is DOUBTFUL until Sun or field confirm it or the fixes return to the former
/// attitude. An attitude that only its first fix supports yields at once to star fixes that agree
/// on another.
///
/// The quality of the estimate is
///     CONVERGING nothing contradicts the attitude, but since it began fewer than ten star fixes
///                (or their equivalent in directions about every axis) have checked it; without a
///                gyro the filter begins again at each fix; or it has rejected the last sample of a
///                sensor, so that one of the two is wrong; or it follows a lost attitude, and
///                neither a second kind of sensor nor a minute has confirmed it yet. Sigma then
///                covers what contradicted the lost one
///     OK         enough samples have checked the attitude and nothing contradicts it
///     DOUBTFUL   samples of one sensor are rejected while those of another agree, and nobody knows
///                which is wrong; or sensors compared without the attitude contradict each other
///                (sensor_contradictions.h); or samples scatter beyond their noise and raise the
///                covariance; or sensors contradict each other by more than errors of the mission
///                file as stated explain (alignment_evidence.h); or the gyro is out, or was out and
///                nothing has yet checked how the body turned meanwhile; or the standard deviation
///                exceeds 10 deg
///     LOST       the attitude may be any, as the covariance states; reported once per loss

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/observation/ledger.h"
#include "pipelines/three_axis/carried_directions.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/frozen_samples.h"
#include "pipelines/three_axis/gyro_unit.h"
#include "pipelines/three_axis/gyro_watch.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/rival_attitude.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/three_axis/sensor_contradictions.h"
#include "pipelines/three_axis/sensor_errors.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

class AttitudeEstimator {
 public:
  using Products = std::vector<ThreeAxisProduct>;

  /// Longest time after a gyro sample for which the next one is awaited.
  static constexpr double kGyroWait_s = 2.5;
  /// Number of consecutive rejected samples, over all sensors, at which the attitude is lost.
  static constexpr int kLostInARow = 10;
  /// Time for which a sensor supports the attitude after the filter accepted its last sample.
  static constexpr double kHeld_s = 10.0;
  /// Number of star fixes, or their equivalent in directions about the least checked axis, that
  /// must have been accepted before the attitude counts as checked.
  static constexpr double kEnoughToCheck = 10.0;
  /// Time after which an attitude that follows a lost one is confirmed by one kind of sensor alone.
  static constexpr double kConfirmedAnew_s = 60.0;

  explicit AttitudeEstimator(const ThreeAxisConfig& config);

  // Precondition: samples arrive in time order, and the mission has the sensors they come from.
  void push(const GyroSample& sample, Products& out);
  void push(const StarFix& fix, Products& out);
  void push(const SeenDirection& seen, Products& out);

  /// Processes the waiting samples without a further gyro sample and emits the newest attitude.
  /// Call this when no more samples are expected for now.
  void settle(Products& out);

  /// Records a sample that was rejected by a test other than that of its innovation.
  void leave_out(const RejectedSample& rejected, Products& out);
  /// Counts a sample as accepted that the filter itself does not process, such as an orbit state.
  void note_accepted(SampleKind kind, TaiTime t);

  const SensorHealths& sensors() const { return sensors_; }
  /// Returns whether the last sample of a sensor other than the gyro repeated the one before it, so
  /// that it is no measurement.
  bool has_repeated(SampleKind kind) const { return frozen_.at(index_of(kind)).repeats() > 0; }
  /// Returns the filter; empty before the attitude has begun and after it was lost.
  const std::optional<Mekf>& filter() const { return filter_; }
  /// Returns the largest ratio of observed to stated variance among the sensors, at least 1.
  double excess_noise() const;
  bool ever_began() const { return since_.has_value(); }
  /// Returns the epoch of the last attitude given.
  std::optional<TaiTime> given() const { return given_; }

 private:
  using Sample = std::variant<StarFix, SeenDirection>;

  std::optional<RejectedSample> judge(const GyroSample& sample);
  void compare_refused(const GyroSample& sample);
  void take_in_gyro(const GyroSample& sample, Products& out);
  void decide_suspect(const GyroSample& next, Products& out);
  void leave_out_suspect(const GyroDeviation& off, Products& out);
  void leave_out_suspect(Products& out);
  void give_way(TaiTime t, Products& out);
  bool is_frozen(TaiTime t, SampleKind kind, const FrozenSamples::Values& values, double noise,
                 Products& out);
  void push_direct(const Sample& sample, Products& out);
  bool waits_for_gyro(TaiTime t) const;
  void take_in_waiting(Products& out);
  void take_in(const Sample& sample, Products& out);
  ObservedAttitude observed_by(const StarFix& fix) const;
  void take_in_star(const StarFix& fix, Products& out);
  void take_in_direction(const SeenDirection& seen, Products& out);
  void tell_contradiction(TaiTime t, Products& out);
  void look_for_culprit(TaiTime t);
  const std::optional<SensorContradiction>& contradiction() const;
  template <class Observed>
  bool work_in(TaiTime t, SampleKind kind, const Observed& observed, Products& out);
  void overrule(Products& out);

  /// Describes the interval between two consecutive gyro samples.
  struct Interval {
    TaiTime from;
    double length_s;
    bool is_gap;
    double change_rad_s;  ///< Norm of the change of rate across the interval.
  };
  void note_gap(double length_s);
  void follow(const GyroSample& to, const Interval& interval);
  void coast(TaiTime t, Products& out);
  double coasted_rad2(TaiTime measured, TaiTime t) const;
  RateSpan span_to(const GyroSample& to) const;
  void turn(const GyroSample& to, double turn_rad2);

  Mekf filter_at(const SensitiveAttitude& attitude) const;
  void begin(const SensitiveAttitude& attitude, Products& out);
  void start(Products& out);
  void lose_where_unknown(Products& out);
  void lose_where_rejected(Products& out);
  void lose(Products& out);
  void give(Products& out);
  void give_where_due(Products& out);
  const ObservationRecord& record_of(SampleKind kind) const { return ledger_.of(source_of(kind)); }
  void forget_gyro();
  Eigen::Vector3d rate_body_rad_s() const;
  bool gyro_is_out() const;
  bool is_confirmed() const;
  bool is_confirmed_anew() const;
  bool is_held() const;
  bool is_in_question(SampleKind kind) const;
  bool is_out(SampleKind kind) const;
  bool never_had_gyro() const;
  Reason why_no_gyro() const;
  Assessment assess(double sigma_rad) const;

  ThreeAxisConfig config_;
  FilterAlignment alignment_;
  GyroWatch gyro_;
  GyroUnit gyro_unit_;
  std::optional<GyroSample> suspect_;  ///< Outlier candidate; the next gyro sample decides.
  std::deque<Sample> waiting_;         ///< Fixes and directions later than the last gyro sample.

  TaiTime begun_ = {};                         ///< Epoch of the first sample.
  std::optional<TaiTime> t_;                   ///< Epoch to which the attitude is propagated.
  std::optional<Eigen::Vector3d> rate_rad_s_;  ///< Measured rate at `t_`; empty before the first.
  bool coasting_ = false;  ///< True while `rate_rad_s_` is an older rate that is held.
  std::optional<Mekf> filter_;
  bool has_fixes_ = false;  ///< True once star fixes support the filter's attitude.
  SensorContradictions contradictions_;
  /// A contradiction that only all innovations together show.
  std::optional<SensorContradiction> by_errors_;
  std::optional<GyroSample> refused_;  ///< Last gyro sample in a wrong unit.
  bool gyro_was_wrong_ = false;        ///< True once the other sensors have contradicted the gyro.
  CarriedDirections carried_;          ///< Directions collected while there is no filter.
  std::optional<RivalAttitude> rival_;

  /// One watch per sample kind; the gyro's is unused (GyroWatch has its own).
  std::vector<FrozenSamples> frozen_{kSampleKinds, FrozenSamples::of_references()};
  SensorHealths sensors_;
  // The following members describe the time since the filter last began.
  Ledger ledger_;
  /// Time of the last sample of each kind, if it was rejected by its innovation.
  std::array<std::optional<TaiTime>, kSampleKinds> rejected_;
  int rejected_in_a_row_ = 0;
  Eigen::Matrix3d checked_ = Eigen::Matrix3d::Zero();  ///< Sum of checked-axis projectors, ICRF.
  double checks_ = 0.0;                                ///< Smallest eigenvalue of `checked_`.
  std::int64_t unchecked_gaps_ = 0;  ///< Gyro gaps since the attitude was last checked.
  double longest_gap_s_ = 0.0;       ///< Longest of the unchecked gaps.
  std::optional<TaiTime> since_;
  bool began_anew_ = false;
  double contradicted_rad_ = 0.0;  ///< Largest innovation since the last sample was accepted.
  /// Largest innovation of the attitude that was lost, until the one since then is confirmed.
  std::optional<double> lost_by_rad_;
  std::optional<TaiTime> given_;       ///< Epoch of the last estimate.
  std::optional<TaiTime> bias_given_;  ///< Epoch of the last estimate with a gyro bias.
  Innovations since_given_;            ///< Innovations since the last estimate.
};

}  // namespace spindrift
