#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/wgs84.h"
#include "tests/support/matchers.h"

namespace spindrift::shadow_test {

TEST(Shadow, IsBehindTheEarthWithinItsRadius) {
  const Eigen::Vector3d sun = Eigen::Vector3d::UnitX();
  const double radius_km = wgs84::kEquatorialRadius_km;
  EXPECT_TRUE(is_in_shadow({-7000.0, 0.0, radius_km - 1.0}, sun));
  EXPECT_FALSE(is_in_shadow({-7000.0, 0.0, radius_km + 1.0}, sun));
  EXPECT_FALSE(is_in_shadow({7000.0, 0.0, 0.0}, sun));
  EXPECT_TRUE(is_in_shadow({-42164.0, 6000.0, 2000.0}, sun));
}

}  // namespace spindrift::shadow_test
