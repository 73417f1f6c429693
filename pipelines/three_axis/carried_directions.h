/// @file
/// Directions of the last seconds, carried along with the gyro until two of them give an attitude.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/three_axis/attitude_from_vectors.h"
#include "pipelines/three_axis/carry_error.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

class CarriedDirections {
 public:
  /// Carried by a gyro, a direction older than that is forgotten.
  static constexpr double kLongest_s = 5.0;

  /// Takes the place of the one before of its sensor.
  void add(SampleKind kind, TaiTime t, const ObservedDirection& direction);

  /// The body turns until `t`.
  /// @param longest_s A direction older than that is forgotten.
  void turn(TaiTime t, const Eigen::Vector3d& turned_rad, const CarryError& error,
            double longest_s = kLongest_s);

  void forget() { directions_.clear(); }

  /// @return Unobservable for fewer than two, nearly in line, or at another angle to each other
  ///         than noise explains.
  Expected<UncertainAttitude> attitude() const;

 private:
  struct Carried {
    SampleKind kind;
    TaiTime t;
    ObservedDirection direction;  ///< In the body as it stands now; its own error.
    CarryError error;
  };
  std::vector<Carried> directions_;  ///< One of a kind, in the order of kinds.
};

}  // namespace spindrift
