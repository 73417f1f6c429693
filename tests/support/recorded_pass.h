/// @file
/// The recorded passes of tests/data/spin, read without the services.

#pragma once

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift::testing {

struct RecordedPass {
  SpinConfig config;
  Orbit orbit;
  std::vector<Pulse> pulses;       ///< In the order of the file; none where frames are.
  std::vector<CodedFrame> frames;  ///< Likewise.
  std::set<Pulse> bad_edges;       ///< Spoilt and spurious ones, as truth.json names them.
  Eigen::Vector3d true_axis_icrf;
  double true_rate_rad_s;
};

/// @param name A folder of tests/data/spin. Throws where a file cannot be read.
RecordedPass recorded_pass(const std::string& name);

}  // namespace spindrift::testing
