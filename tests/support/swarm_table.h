/// @file
/// Measurements of Swarm's magnetometer (tests/data/geomagnetism).

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/local_frame.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing {

/// Gives access to the rows by column name; a vector is written {x;y;z}.
struct SwarmTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  const std::string& at(std::size_t row, const std::string& name) const {
    return rows[row][static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
  }
  double number(std::size_t row, const std::string& name) const { return std::stod(at(row, name)); }
  Eigen::Vector3d vector(std::size_t row, const std::string& name) const {
    Eigen::Vector3d read;
    EXPECT_EQ(std::sscanf(at(row, name).c_str(), "{%lf;%lf;%lf}", &read.x(), &read.y(), &read.z()),
              3);
    return read;
  }
  LocalFrame frame(std::size_t row) const {
    return local_frame(GeocentricPlace{.latitude_rad = number(row, "Latitude") * kRadPerDeg,
                                       .longitude_rad = number(row, "Longitude") * kRadPerDeg,
                                       .radius_km = 1e-3 * number(row, "Radius")})
        .value();
  }
};

inline std::vector<std::string> split_row(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream{line.substr(0, line.find('\r'))};
  for (std::string field; std::getline(stream, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

inline SwarmTable swarm_table(const std::string& name) {
  std::ifstream file{test_data() / "geomagnetism" / name};
  SwarmTable table;
  std::string line;
  std::getline(file, line);
  table.names = split_row(line);
  while (std::getline(file, line)) {
    table.rows.push_back(split_row(line));
  }
  return table;
}

}  // namespace spindrift::testing
