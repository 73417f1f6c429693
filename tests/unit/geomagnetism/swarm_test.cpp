/// Measurements of Swarm's magnetometer compared with the model (tests/data/geomagnetism).

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"

namespace spindrift::swarm_test {

using Eigen::Vector3d;

/// Gives access to the rows by column name; a vector is written {x;y;z}.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  const std::string& at(std::size_t row, const std::string& name) const {
    return rows[row][static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
  }
  double number(std::size_t row, const std::string& name) const { return std::stod(at(row, name)); }
  Vector3d vector(std::size_t row, const std::string& name) const {
    Vector3d read;
    EXPECT_EQ(std::sscanf(at(row, name).c_str(), "{%lf;%lf;%lf}", &read.x(), &read.y(), &read.z()),
              3);
    return read;
  }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream{line.substr(0, line.find('\r'))};
  for (std::string field; std::getline(stream, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

Table read(const std::string& name) {
  std::ifstream file{test_data() / "geomagnetism" / name};
  Table table;
  std::string line;
  std::getline(file, line);
  table.names = split(line);
  while (std::getline(file, line)) {
    table.rows.push_back(split(line));
  }
  return table;
}

/// Returns the rms angle between the measurements and the model, deg.
double apart_deg(const Table& table, double year) {
  const MainField field = igrf().value().at(year).value();
  double squares_rad2 = 0.0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const GeocentricPlace place{.latitude_rad = table.number(row, "Latitude") * kRadPerDeg,
                                .longitude_rad = table.number(row, "Longitude") * kRadPerDeg,
                                .radius_km = 1e-3 * table.number(row, "Radius")};
    const Vector3d model_nt = field.ned_at(local_frame(place).value()).value();
    squares_rad2 += std::pow(angle_between_rad(table.vector(row, "B_NEC"), model_nt), 2);
  }
  return degrees(std::sqrt(squares_rad2 / static_cast<double>(table.rows.size())));
}

TEST(Swarm, IsATenthOfADegreeFromTheModelWhereItIsQuiet) {
  const Table table = read("swarmA_20190101_MAGA_LR_5samples.csv");
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_NEAR(apart_deg(table, 2019.0), 0.055, 0.001);
}

TEST(Swarm, IsAThirdOfADegreeFromTheModelInADisturbedPolarPass) {
  const Table table = read("swarmA_20160101_192rows.csv");
  ASSERT_EQ(table.rows.size(), 192U);
  EXPECT_NEAR(apart_deg(table, 2016.0), 0.37, 0.005);
}

}  // namespace spindrift::swarm_test
