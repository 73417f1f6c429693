/// @file
/// A recorded pass of a three-axis spacecraft with its truth (tests/data/three-axis).

#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift::testing {

struct TrueAttitude {
  TaiTime t;
  Eigen::Quaterniond q_icrf_body;
};

struct RecordedSeparation {
  ThreeAxisConfig sensors;
  std::optional<Orbit> orbit;
  SeparationTimes times;
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  std::map<std::string, TrueAttitude> truth;  ///< True attitudes, keyed "T1" to "T4".

  ReconstructionRequest request() const {
    return {.sensors = sensors,
            .times = times,
            .gyro = gyro,
            .sun_directions = sun,
            .star_fixes = stars,
            .orbit = orbit};
  }
};

/// @param name Name of a folder in tests/data/three-axis.
RecordedSeparation recorded_separation(const std::string& name);

}  // namespace spindrift::testing
