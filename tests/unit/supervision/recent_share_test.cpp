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

TEST(RecentShare, CountsEdgesWithoutARevolutionWithTheLastOne) {
  RecentShare share{2};
  share.count(1, false);
  EXPECT_FALSE(share.count_without_revolution());
  share.count(2, false);
  share.count(2, false);
  EXPECT_EQ(share.count(3, false), 25.0);
}

TEST(RecentShare, WithoutRevolutionsSixEdgesAreATurn) {
  RecentShare share{2};
  for (int edge = 0; edge < 12; ++edge) {
    EXPECT_FALSE(share.count_without_revolution()) << edge;
  }
  EXPECT_EQ(share.count_without_revolution(), 100.0);
  share.count(1, false);
  // One edge of the third turn and one of this revolution.
  EXPECT_EQ(share.count(2, false), 50.0);
}

}  // namespace spindrift::recent_share_test
