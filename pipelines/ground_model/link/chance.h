/// @file
/// Random numbers that are the same with every standard library, unlike its distributions.

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

#include "pipelines/frames/angle.h"

namespace spindrift {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_{seed} {}

  /// Returns a uniform number in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  /// Returns a uniform number in [-1, 1).
  double either_way() { return 2.0 * uniform() - 1.0; }
  /// Returns a standard normal number, by the method of Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(kTurn_rad * uniform());
  }
  /// Returns a vector of independent normal elements.
  Eigen::Vector3d normal_vector(double sigma) {
    const double x = normal();
    const double y = normal();
    return {sigma * x, sigma * y, sigma * normal()};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace spindrift
