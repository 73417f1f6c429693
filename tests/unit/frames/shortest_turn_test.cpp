#include "pipelines/frames/shortest_turn.h"

#include <numbers>

#include "tests/support/matchers.h"

namespace spindrift::shortest_turn_test {

using Eigen::Vector3d;

TEST(ShortestTurn, TurnsOneDirectionIntoTheOtherAboutTheAxisAcrossBoth) {
  const Vector3d from{0.3, -2.0, 1.0};
  const Vector3d to{-4.0, 0.5, 0.2};
  const Eigen::AngleAxisd turn{shortest_turn(from, to)};
  EXPECT_TRUE((turn * from.normalized()).isApprox(to.normalized(), 1e-14));
  EXPECT_TRUE(turn.axis().isApprox(from.cross(to).normalized(), 1e-14));
}

TEST(ShortestTurn, OfOppositeDirectionsIsHalfATurnAboutAnAxisAcrossThem) {
  const Vector3d from{1.0, 2.0, -2.0};
  const Eigen::AngleAxisd turn{shortest_turn(from, -from)};
  EXPECT_NEAR(turn.angle(), std::numbers::pi, 1e-12);
  EXPECT_NEAR(turn.axis().dot(from), 0.0, 1e-12);
}

}  // namespace spindrift::shortest_turn_test
