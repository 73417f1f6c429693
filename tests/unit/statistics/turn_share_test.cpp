#include "pipelines/statistics/turn_share.h"

#include "tests/support/matchers.h"

namespace spindrift::turn_share_test {

TEST(TurnShare, IsThatOfTheLastTurnsOnceThereAreSoMany) {
  TurnShare share{2, 6};
  EXPECT_FALSE(share.count(1, true));
  EXPECT_FALSE(share.count(1, false));
  EXPECT_FALSE(share.count(2, false));
  EXPECT_FALSE(share.count(2, false));
  EXPECT_EQ(share.count(3, false), 25.0);
  EXPECT_EQ(share.count(4, false), 0.0);
}

TEST(TurnShare, CountsItemsWithoutATurnWithTheLastOne) {
  TurnShare share{2, 6};
  share.count(1, false);
  EXPECT_FALSE(share.count({}, true));
  share.count(2, false);
  share.count(2, false);
  EXPECT_EQ(share.count(3, false), 25.0);
}

TEST(TurnShare, KeepsTheTurnsCountedWhenTheWindowIsOfOtherLength) {
  TurnShare share{3, 6};
  for (const int turn : {1, 2, 3}) {
    share.count(turn, turn == 1);
  }
  share.set_turns(2);
  EXPECT_EQ(share.count(4, true), 0.0);
  share.set_turns(4);
  EXPECT_FALSE(share.count(5, true));
  EXPECT_FALSE(share.count(6, true));
  EXPECT_EQ(share.count(7, false), 75.0);
}

TEST(TurnShare, WithoutTurnsSoManyItemsAreOne) {
  TurnShare share{2, 6};
  for (int item = 0; item < 12; ++item) {
    EXPECT_FALSE(share.count({}, true)) << item;
  }
  EXPECT_EQ(share.count({}, true), 100.0);
  share.count(1, false);
  // One item of the third turn and one of this revolution.
  EXPECT_EQ(share.count(2, false), 50.0);
}

}  // namespace spindrift::turn_share_test
