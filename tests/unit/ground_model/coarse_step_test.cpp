#include "pipelines/ground_model/dynamics/rigid_body.h"
#include "tests/support/matchers.h"

namespace spindrift::coarse_step_test {

TEST(CoarseStep, IsSaidWithTheStepThatWouldDo) {
  EXPECT_TRUE(check_step(0.05, 0.1));
  EXPECT_THAT(check_step(0.5, 1.0),
              IsRefused(ErrorCode::InvalidConfiguration, HasSubstr("must not be above 0.1 s")));
  EXPECT_THAT(check_step(0.0, 1.0).error().message, HasSubstr("must be above 0"));
  EXPECT_FALSE(check_step(-0.1, 1.0));
  EXPECT_FALSE(check_step(std::nan(""), 1.0));
}

}  // namespace spindrift::coarse_step_test
