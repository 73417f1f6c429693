#include "pipelines/supervision/recent_share.h"

#include <gtest/gtest.h>

namespace spindrift::recent_share_test {

TEST(RecentShare, IsThatOfTheLastRevolutionsOnceThereAreSoMany) {
  RecentShare share{2};
  EXPECT_FALSE(share.count(1, true));
  EXPECT_FALSE(share.count(1, false));
  EXPECT_FALSE(share.count(2, false));
  EXPECT_FALSE(share.count(2, false));
  EXPECT_EQ(share.count(3, false), 25.0);
  EXPECT_EQ(share.count(4, false), 0.0);
}

}  // namespace spindrift::recent_share_test
