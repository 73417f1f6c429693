#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift::coarse_step_test {

using ::testing::HasSubstr;

TEST(CoarseStep, IsSaidWithTheStepThatWouldDo) {
  EXPECT_TRUE(check_step(0.05, 0.1));
  const auto coarse = check_step(0.5, 1.0);
  ASSERT_FALSE(coarse);
  EXPECT_EQ(coarse.error().code, ErrorCode::InvalidConfiguration);
  EXPECT_THAT(coarse.error().message, HasSubstr("must not be above 0.1 s"));
  EXPECT_THAT(check_step(0.0, 1.0).error().message, HasSubstr("must be above 0"));
  EXPECT_FALSE(check_step(-0.1, 1.0));
  EXPECT_FALSE(check_step(std::nan(""), 1.0));
}

}  // namespace spindrift::coarse_step_test
