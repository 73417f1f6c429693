/// @file
/// What the magnetometer of a three-axis spacecraft measures.

#pragma once

#include <Eigen/Core>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct MagneticField {
  TaiTime t;
  Eigen::Vector3d field_body_nt = Eigen::Vector3d::Zero();
};

}  // namespace spindrift
