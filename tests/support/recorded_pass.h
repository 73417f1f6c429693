/// @file
/// Reads the recorded passes of tests/data/spin without the services.

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
  std::vector<Pulse> pulses;       ///< Pulses in file order; empty if the pass has coded frames.
  std::vector<CodedFrame> frames;  ///< Frames in file order; empty if the pass has pulses.
  std::set<Pulse> bad_edges;       ///< Displaced and spurious edges named in truth.json.
  Eigen::Vector3d true_axis_icrf;
  double true_rate_rad_s;
};

/// Reads a pass; throws if a file cannot be read.
/// @param name Name of a folder in tests/data/spin.
RecordedPass recorded_pass(const std::string& name);

}  // namespace spindrift::testing
