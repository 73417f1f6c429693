/// @file
/// This file compares the sensors of a three-axis spacecraft two at a time, without the attitude of
/// a filter, and says which of them is wrong.
///
///     star and gyro       the turn between two star fixes
///     sun and gyro        the turn of the direction to the Sun
///     star and sun, star and magnetometer
///                         the direction in an attitude interpolated between two star fixes
///     sun and magnetometer
///                         the angle between Sun and field
///     magnetometer and orbit
///                         the strength of the field
///
/// What the errors of the mission file as stated explain is no contradiction (sensor_pair.h). Where
/// pairs contradict each other, the culprit is the sensor that, left out, makes the others agree.
/// If two contradict each other and no other pair shows which, a third sensor may vouch for one of
/// the two: it agrees with it, and would not if that one were so far off. A gyro that is right in
/// another unit, or whose noise is far beyond the stated one, contradicts itself. A field that is
/// wrong in direction and strength is the magnetometer's or the orbit's (field_departure.h).

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/field_departure.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/sensor_pair.h"

namespace spindrift {

class SensorContradictions {
 public:
  explicit SensorContradictions(const ThreeAxisConfig& config);

  // Precondition: turns, fixes and directions come in time order.

  /// Adds a turn that the gyro has measured.
  /// @param turn_rad2 Variance of the turn by noise.
  void turn(const RateSpan& span, double turn_rad2);
  /// Notes that the turn since the last call of `turn` is not measured.
  void lose_gyro() { ++carried_.losses; }
  /// Notes whether the gyro's rates agree with the star fixes in another unit only.
  void note_unit(bool is_wrong) { gyro_unit_is_wrong_ = is_wrong; }
  /// Notes the noise that the gyro's samples have at `t`.
  void note_scatter(TaiTime t, double noise_rad_s);
  void add(TaiTime t, const ObservedAttitude& fix);
  void add(const SeenDirection& seen);

  /// Returns the contradiction that the samples up to now show; empty if there is none.
  const std::optional<SensorContradiction>& found() const { return found_; }
  /// Returns whether any samples up to now have shown one.
  bool has_found() const { return has_found_; }

 private:
  /// Sums of what the gyro has measured; differences of two are what it has measured in between.
  struct Carried {
    Eigen::Quaterniond q_start_body = Eigen::Quaterniond::Identity();
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
    double turned_rad = 0.0;    ///< Sum of the lengths of the turns.
    double noise_rad2 = 0.0;    ///< Variance of the turn.
    double change_rad_s = 0.0;  ///< Sum of the changes of the rate.
    double bend_rad = 0.0;      ///< What the rate may have turned unseen between its samples.
    int losses = 0;
  };
  struct Fix {
    TaiTime t;
    ObservedAttitude seen;
    Carried carried;
  };
  struct Direction {
    SeenDirection seen;
    Carried carried;
  };
  /// The course of the attitude between two star fixes.
  struct Arc {
    Fix from;
    double length_s;
    Eigen::Vector3d turned_rad;
    double change_rad_s;  ///< Change of the mean rate since the arc before.
  };
  struct Pair {
    SampleKind first;
    SampleKind second;
    SensorPair test = {};

    bool has(SampleKind kind) const { return first == kind || second == kind; }
    SampleKind other(SampleKind kind) const { return kind == first ? second : first; }
  };

  void compare_star_and_gyro(const Fix& from, const Fix& to);
  void compare_star(const Arc& arc, const SeenDirection& seen);
  void compare_with_gyro(const Direction& from, const Direction& to);
  void compare_with_field(const Direction& from, const Direction& to);
  void compare_strength(const SeenDirection& field);
  TurnPerPairError direction_errors(const SeenDirection& seen,
                                    const Eigen::Vector3d& rate_rad_s) const;

  void add(TaiTime t, SampleKind one, SampleKind other, const PairComparison& compared);
  void decide(TaiTime t);
  std::optional<SensorContradiction> contradiction_at(TaiTime t);
  double most_sigmas_without(SampleKind kind, TaiTime t) const;
  bool is_vouched_for(SampleKind kind, const Pair& accused, TaiTime t) const;
  std::optional<SampleKind> culprit_of(const Pair& worst, TaiTime t) const;
  std::optional<SampleKind> field_or_orbit(TaiTime t) const;
  bool is_noisy() const;
  std::optional<SensorContradiction> scatter(TaiTime t) const;

  PairPrior prior_ = PairPrior::Zero();
  std::array<Pair, 6> pairs_;
  Carried carried_;
  std::optional<Fix> fix_;
  std::optional<Eigen::Vector3d> star_rate_rad_s_;  ///< Mean rate of the last arc.
  std::optional<Direction> sun_;
  std::optional<Direction> sun_begin_;  ///< Begin of the present comparison of Sun and gyro.
  std::optional<Direction> field_;
  FieldDeparture departure_;
  bool gyro_unit_is_wrong_ = false;
  double stated_noise_rad_s_ = 0.0;  ///< Noise of the gyro as the mission file has it.
  double gyro_noise_rad_s_ = 0.0;
  std::optional<SensorContradiction> found_;
  bool has_found_ = false;
};

}  // namespace spindrift
