/// @file
/// The measurement of a three-axis spacecraft's magnetometer.

#pragma once

#include <Eigen/Core>

#include "pipelines/three_axis/samples.h"

namespace spindrift {

struct MagneticField {
  TaiTime t;
  Eigen::Vector3d field_body_nt = Eigen::Vector3d::Zero();
  Sender sender = Sender::First;
};

inline bool say_the_same(const MagneticField& a, const MagneticField& b) {
  return same_but_for_rounding(a.field_body_nt, b.field_body_nt);
}

}  // namespace spindrift
