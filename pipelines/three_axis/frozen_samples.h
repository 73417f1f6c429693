/// @file
/// Detects repeating samples, of a frozen sensor or of one with noise below the quantisation step.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/three_axis/products.h"

namespace spindrift {

class FrozenSamples {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 4, 1>;

  /// Run of repeats that counts as frozen while no rate has ever changed and the step is unknown.
  static constexpr int kGyroInARow = 10;

  /// Returns the detector for a gyro. Fewer than five repeats change the attitude little, whatever
  /// the true rate was. Each axis is tested alone as well, because one axis can fail on its own.
  static FrozenSamples of_gyro() { return {{.known = 5, .unknown = kGyroInARow}, true}; }
  /// Returns the detector for star fixes and directions. Each sample is complete by itself, so that
  /// even the second of a run adds nothing, and two samples suffice to show the step that all
  /// values share. Only all values together are tested, as one may stand still by geometry.
  static FrozenSamples of_references() { return {{.known = 2, .unknown = 2}, false}; }

  /// Learns the quantisation step from two consecutive samples. For a gyro it is the smallest
  /// change on each axis, else the largest step that divides all changes.
  void learn(const Values& earlier, const Values& later);

  /// Tests the next sample for repetition.
  /// @param noise Standard deviation of each value.
  /// @return Length of the run of equal samples, in all values or in one, that ends here; 0 if it
  ///         is below the minimum or noise causes it with a probability above 1e-9.
  int repeated(const Values& values, double noise);

  /// Calls `learn` with the previous sample and then `repeated`.
  int learn_and_test(const Values& values, double noise);

  /// Returns the result of `repeated` for the last sample.
  int repeats() const { return repeats_; }
  /// Returns the run length of the last sample and the longest run that is still acceptable.
  FailedTest failed() const { return {static_cast<double>(repeats_), most_by_chance_}; }

  /// Returns the coarsest quantisation step of all values; 0 if no value ever changed.
  double step() const;

 private:
  struct Fewest {
    int known;    ///< Minimum run when the step is known.
    int unknown;  ///< Minimum run when the step is unknown.
  };
  FrozenSamples(const Fewest& fewest, bool is_gyro) : fewest_{fewest}, is_gyro_{is_gyro} {}

  double finest_step() const;
  double longest_by_chance(const Values& steps, double noise) const;

  Fewest fewest_;
  bool is_gyro_;
  Values steps_;  ///< Step of each value; 0 if it never changed.
  Values last_;
  std::vector<int> in_a_row_;  ///< Run length of all values together, then of each value.
  int repeats_ = 0;
  double most_by_chance_ = 0.0;
};

}  // namespace spindrift
