#include "services/serving/session_watch.h"
#include "tests/support/matchers.h"

namespace spindrift::gap_watch_test {

using Gaps = std::map<std::string, std::uint64_t>;

std::map<std::string, SequenceCounts> missing(const Gaps& gaps) {
  std::map<std::string, SequenceCounts> by_source;
  for (const auto& [source, count] : gaps) {
    by_source[source].missing = count;
  }
  return by_source;
}

TEST(GapWatch, TellsOfAGapAtTheSecondBeat) {
  GapWatch watch;
  EXPECT_EQ(watch.beat(missing({{"front-end", 3}})), Gaps{});
  EXPECT_EQ(watch.beat(missing({{"front-end", 3}})), (Gaps{{"front-end", 3}}));
}

TEST(GapWatch, LeavesOutWhatArrivesBeforeTheNextBeat) {
  GapWatch watch;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(watch.beat(missing({{"front-end", 3}})), Gaps{});
    EXPECT_EQ(watch.beat(missing({{"front-end", 0}})), Gaps{});
  }
}

TEST(GapWatch, KeepsTheSourcesApart) {
  GapWatch watch;
  EXPECT_EQ(watch.beat(missing({{"north", 3}, {"south", 0}, {"west", 5}})), Gaps{});
  EXPECT_EQ(watch.beat(missing({{"north", 7}, {"south", 2}, {"west", 1}})),
            (Gaps{{"north", 3}, {"west", 1}}));
}

TEST(GapWatch, NamesEachSourceInItsText) {
  EXPECT_EQ(to_text({{"north", 3}, {"west", 1}}), "north 3, west 1");
}

}  // namespace spindrift::gap_watch_test
