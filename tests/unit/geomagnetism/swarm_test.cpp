/// Measurements of Swarm's magnetometer compared with the model (tests/data/geomagnetism).

#include <Eigen/Dense>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"
#include "tests/support/swarm_table.h"

namespace spindrift::swarm_test {

using Eigen::Vector3d;
using testing::swarm_table;
using testing::SwarmTable;

/// Returns the rms angle between the measurements and the model, deg.
double apart_deg(const SwarmTable& table, double year) {
  const MainField field = igrf().value().at(year).value();
  double squares_rad2 = 0.0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const Vector3d model_nt = field.ned_at(table.frame(row)).value();
    squares_rad2 += std::pow(angle_between_rad(table.vector(row, "B_NEC"), model_nt), 2);
  }
  return degrees(std::sqrt(squares_rad2 / static_cast<double>(table.rows.size())));
}

TEST(Swarm, IsATenthOfADegreeFromTheModelWhereItIsQuiet) {
  const SwarmTable table = swarm_table("swarmA_20190101_MAGA_LR_5samples.csv");
  ASSERT_EQ(table.rows.size(), 5U);
  EXPECT_NEAR(apart_deg(table, 2019.0), 0.055, 0.001);
}

TEST(Swarm, IsAThirdOfADegreeFromTheModelInADisturbedPolarPass) {
  const SwarmTable table = swarm_table("swarmA_20160101_192rows.csv");
  ASSERT_EQ(table.rows.size(), 192U);
  EXPECT_NEAR(apart_deg(table, 2016.0), 0.37, 0.005);
}

}  // namespace spindrift::swarm_test
