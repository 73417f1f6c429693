#include "pipelines/time/time_jump.h"

#include "tests/support/matchers.h"

namespace spindrift::time_jump_test {

TaiTime at(std::int64_t t_s) { return tai_from_ns(t_s * 1'000'000'000); }

TEST(TimeJump, IsShownByAStreamThatGoesOnFromThere) {
  TimeJump jump;
  jump.hear(0);
  for (std::int64_t t_s = 0; t_s < 20; ++t_s) {
    jump.add_ahead(at(1000 + t_s), 0);
    EXPECT_FALSE(jump.has_shown());
  }
  EXPECT_TRUE(jump.could_be());
  jump.add_ahead(at(1020), 0);
  EXPECT_TRUE(jump.has_shown());
}

TEST(TimeJump, IsNotShownWhileTheTimeBeforeGoesOnHoweverManyThereAre) {
  TimeJump jump;
  for (std::int64_t t_s = 0; t_s < 1000; ++t_s) {
    jump.hear(0);
    for (int i = 0; i < 100; ++i) {
      jump.add_ahead(at(100'000 + t_s), 0);
    }
    EXPECT_FALSE(jump.has_shown());
  }
}

TEST(TimeJump, IsNotShownBySamplesThatDoNotFollowOneAnother) {
  TimeJump jump;
  for (std::int64_t i = 0; i < 1000; ++i) {
    jump.add_ahead(at(100'000 + 61 * (i * 7919 % 1009)), 0);
    EXPECT_FALSE(jump.has_shown());
  }
}

TEST(TimeJump, IsNotShownByOneKindAloneWhereThereAreSeveral) {
  TimeJump jump;
  jump.hear(1);
  jump.hear(2);
  for (std::int64_t t_s = 0; t_s < 1000; ++t_s) {
    jump.add_ahead(at(100'000 + t_s), 1);
  }
  EXPECT_FALSE(jump.could_be());
  jump.add_ahead(at(101'000), 2);
  EXPECT_TRUE(jump.has_shown());
}

}  // namespace spindrift::time_jump_test
