#include "services/mission/nearest_name.h"

#include "tests/support/matchers.h"

namespace spindrift::nearest_name_test {

TEST(NearestName, IsTheOneThatAPersonMeant) {
  const std::vector<std::string> names = {"slit_cant_deg", "slit_separation_deg", "oem", "e"};
  EXPECT_EQ(nearest_name("slit_cant_dge", names), "slit_cant_deg");
  EXPECT_EQ(nearest_name("slit_cant", names), "slit_cant_deg");
  EXPECT_EQ(nearest_name("slitcantdeg", names), "slit_cant_deg");
  EXPECT_EQ(nearest_name("ome", names), "oem");
}

TEST(NearestName, IsEmptyWhereNothingIsNear) {
  const std::vector<std::string> names = {"slit_cant_deg", "oem", "e"};
  EXPECT_EQ(nearest_name("temperature", names), "");
  EXPECT_EQ(nearest_name("x", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("oem", {}), "");
}

}  // namespace spindrift::nearest_name_test
