/// @file
/// Attitude and gyro bias from samples in order of time: begins, filters, gates, says how good it
/// is, and begins anew (mekf.h).
///
/// It begins at a star fix, or at two directions that agree (carried_directions.h); before that
/// there is nothing. A star fix or a direction between two gyro samples is taken in when the second
/// is there, as the rate changes evenly between them; where none comes the last rate is held, and
/// the covariance grows by what the rate has shown of changing. Without any gyro two directions of
/// within a second give the attitude of that instant, as a star fix does. An attitude that all
/// sensors reject, or that nothing has held for long, is LOST. Then it begins at the next fix.
///
/// Samples that repeat to the bit are left out (frozen_samples.h). Star fixes that the attitude
/// rejects and that agree with each other make a rival (rival_attitude.h). Sun and field decide
/// between the two; where they do not, the fixes overrule in the end, and whatever they say then is
/// doubtful until Sun or field confirm it or the fixes return to where they were. An attitude that
/// only the fix has spoken for at which it began gives way to the next ones at once.
///
/// Its quality is
///     CONVERGING nothing speaks against it, but no ten fixes, or as much of directions about every
///                axis, have checked it since it began; without a gyro it begins at each fix
///     OK         all is well
///     DOUBTFUL   a sensor's samples are rejected while another's agree, and nobody knows which is
///                wrong, or scatter beyond their noise, and the covariance is raised by that; or
///                the gyro is out, or was and nothing has checked since how the body turned
///                meanwhile; or it is open by 10 deg
///     LOST       it may point anywhere, and the covariance says so; said once

#pragma once

#include <Eigen/Core>
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

namespace spindrift {

/// A direction that a sensor measures, with its reference in ICRF.
struct SeenDirection {
  TaiTime t;
  SampleKind kind;
  ObservedDirection direction;
  /// Of a field: how much stronger it is than known, in standard deviations. Tested with it.
  std::optional<double> stronger = std::nullopt;
};

class AttitudeEstimator {
 public:
  using Products = std::vector<ThreeAxisProduct>;

  /// So long after a gyro sample the next one is expected.
  static constexpr double kGyroWait_s = 2.5;
  /// So many rejected in a row, by all sensors together, and the attitude is lost.
  static constexpr int kLostInARow = 10;
  /// So long a sensor holds the attitude that has accepted its last sample.
  static constexpr double kHeld_s = 10.0;
  /// So much must have been able to contradict the attitude: of star fixes, their number.
  static constexpr double kEnoughToCheck = 10.0;

  explicit AttitudeEstimator(const ThreeAxisConfig& config);

  // All samples not earlier than those before; the mission has their sensors.
  void push(const GyroSample& sample, Products& out);
  void push(const StarFix& fix, Products& out);
  void push(const SeenDirection& seen, Products& out);

  /// Nothing comes for now: what waits for a gyro sample is taken in without, and the newest
  /// attitude is given.
  void settle(Products& out);

  /// A sample that something else than its innovation rules out.
  void leave_out(const RejectedSample& rejected, Products& out);
  /// One of a kind that is of use to something else.
  void note_accepted(SampleKind kind, TaiTime t);

  const SensorHealths& sensors() const { return sensors_; }
  /// Empty: it has not begun, or is lost.
  const std::optional<Mekf>& filter() const { return filter_; }
  bool ever_began() const { return since_.has_value(); }

 private:
  using Sample = std::variant<StarFix, SeenDirection>;

  std::optional<RejectedSample> judge(const GyroSample& sample);
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
  template <class Observed>
  bool work_in(TaiTime t, SampleKind kind, const Observed& observed,
               const std::optional<double>& stronger, Products& out);
  void ask_rival(const ObservedAttitude& fix, bool fits, bool fits_in_force);
  void ask_rival(const ObservedDirection& direction, bool fits, bool fits_in_force);
  bool rival_overrules() const;
  void overrule(Products& out);

  /// Between two gyro samples.
  struct Interval {
    TaiTime from;
    double length_s;
    bool is_gap;
    double change_rad_s;  ///< Of the rate across it.
  };
  void note_gap(double length_s);
  void follow(const GyroSample& to, const Interval& interval);
  void coast(TaiTime t, Products& out);
  double coasted_rad2(TaiTime measured, TaiTime t) const;
  void turn(const GyroSample& to, double turn_rad2);

  Mekf filter_at(const UncertainAttitude& attitude) const;
  void begin(const UncertainAttitude& attitude, Products& out);
  void start(Products& out);
  void lose_where_unknown(Products& out);
  void lose_where_rejected(Products& out);
  void lose(Products& out);
  void give(Products& out);
  void give_where_due(Products& out);
  const ObservationRecord& record_of(SampleKind kind) const { return ledger_.of(source_of(kind)); }
  double excess_noise() const;
  void forget_gyro();
  bool gyro_is_out() const;
  bool is_confirmed() const;
  bool is_held() const;
  bool is_out(SampleKind kind) const;
  Reason why_no_gyro() const;
  Assessment assess() const;

  ThreeAxisConfig config_;
  GyroWatch gyro_;
  GyroUnit gyro_unit_;
  std::optional<GyroSample> suspect_;  ///< Waits for the next to tell what it is.
  std::deque<Sample> waiting_;         ///< For the gyro sample behind them.

  std::optional<TaiTime> t_;                   ///< To which the body has been followed.
  std::optional<Eigen::Vector3d> rate_rad_s_;  ///< As measured, there; empty: no gyro yet.
  bool coasting_ = false;                      ///< That rate is an older one, held.
  std::optional<Mekf> filter_;
  bool has_fixes_ = false;     ///< Star fixes have spoken for that.
  CarriedDirections carried_;  ///< While there is no filter.
  std::optional<RivalAttitude> rival_;

  /// By kind; that of the gyro is not used.
  std::vector<FrozenSamples> frozen_{kSampleKinds, FrozenSamples::of_references()};
  SensorHealths sensors_;
  // Since it began:
  Ledger ledger_;
  int rejected_in_a_row_ = 0;
  Eigen::Matrix3d checked_ = Eigen::Matrix3d::Zero();  ///< About which axes, ICRF.
  double checks_ = 0.0;                                ///< About the axis that is checked least.
  std::int64_t unchecked_gaps_ =
      0;                        ///< Of the gyro, in which the body may have turned and stopped.
  double longest_gap_s_ = 0.0;  ///< Of those.
  std::optional<TaiTime> since_;
  bool began_anew_ = false;
  std::optional<TaiTime> given_;       ///< The last estimate.
  std::optional<TaiTime> bias_given_;  ///< The last estimate with the bias of the gyro.
  Innovations since_given_;            ///< Since that.
};

}  // namespace spindrift
