/// @file
/// The recorded passes of tests/data/spin, read without the services.

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/pulse.h"

namespace spindrift::testing {

struct RecordedPass {
  SpinConfig config;
  Orbit orbit;
  std::vector<Pulse> pulses;  ///< In the order of the file.
  Eigen::Vector3d true_axis_icrf;
  double true_rate_rad_s;
};

/// @param name A folder of tests/data/spin. Throws where a file cannot be read.
RecordedPass recorded_pass(const std::string& name);

}  // namespace spindrift::testing
