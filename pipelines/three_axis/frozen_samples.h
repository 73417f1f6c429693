/// @file
/// Samples of one sensor that repeat: it is frozen, or its noise is below the step of the
/// telemetry.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/three_axis/products.h"

namespace spindrift {

class FrozenSamples {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

  /// While no rate has ever changed nobody knows the step: so many in a row are frozen.
  static constexpr int kGyroInARow = 10;

  /// Fewer than five bend the attitude by little, whatever the gyro did. One axis may be dead
  /// alone.
  static FrozenSamples of_gyro() { return {{.known = 5, .unknown = kGyroInARow}, true}; }
  /// Each by itself is an attitude, or a direction of one: the second of a row tells nothing new,
  /// and two samples must show the step, which all values share. One value of a unit vector may
  /// stand still by geometry: all of them together.
  static FrozenSamples of_references() { return {{.known = 2, .unknown = 2}, false}; }

  /// What the step of the telemetry is: of each rate of a gyro the least change between neighbours,
  /// else the greatest of which all changes are multiples.
  void learn(const Values& earlier, const Values& later);

  /// The next sample.
  /// @param noise One standard deviation of each value.
  /// @return How many up to this one are the same, all values or one, where they are the fewest and
  ///         more than noise makes once in a thousand million times; else 0.
  int repeated(const Values& values, double noise);

  /// Likewise, and learns.
  int note(const Values& values, double noise);

  /// Of the last sample.
  int repeats() const { return repeats_; }
  /// Where it repeats: how many, and how many in a row are not too many.
  FailedTest failed() const { return {static_cast<double>(repeats_), most_by_chance_}; }

  /// Of the value where it is coarsest; 0: no value ever changed.
  double step() const;

 private:
  struct Fewest {
    int known;    ///< Where the step is.
    int unknown;  ///< Where it is not.
  };
  FrozenSamples(const Fewest& fewest, bool is_gyro) : fewest_{fewest}, is_gyro_{is_gyro} {}

  double finest_step() const;
  double longest_by_chance(const Values& steps, double noise) const;

  Fewest fewest_;
  bool is_gyro_;
  Values steps_;  ///< 0: it never changed.
  Values last_;
  std::vector<int> in_a_row_;  ///< All values, then each.
  int repeats_ = 0;
  double most_by_chance_ = 0.0;
};

}  // namespace spindrift
