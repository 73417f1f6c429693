/// @file
/// Star fixes that the attitude rejects and that agree with each other: then the attitude is wrong.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "pipelines/three_axis/carry_error.h"
#include "pipelines/three_axis/mekf.h"

namespace spindrift {

class StarAgreement {
 public:
  /// So many in a row, carried along with the gyro, do not agree by accident, nor do those of a
  /// tracker that is stuck while the body turns.
  static constexpr int kEnough = 3;

  /// A rejected fix.
  /// @return Whether enough agree.
  bool note(const ObservedAttitude& fix);

  /// The body turns.
  void turn(const Eigen::Vector3d& turned_rad, const CarryError& error);

  void forget() { last_.reset(); }

 private:
  struct Last {
    Eigen::Quaterniond q_icrf_body;  ///< As it stands now.
    CarryError error;
    int agreeing;
  };
  std::optional<Last> last_;
};

}  // namespace spindrift
