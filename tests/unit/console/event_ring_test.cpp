#include "services/console/event_ring.h"

#include <string>

#include "tests/support/matchers.h"

namespace spindrift::event_ring_test {

TEST(EventRing, GivesWhatIsBehindAnId) {
  EventRing ring{100};
  ring.append("state", {{"a", 1}});
  ring.append("health", {{"b", 2}});
  const auto news = ring.after(101);
  EXPECT_EQ(news.text, "id: 102\nevent: health\ndata: {\"b\":2}\n\n");
  EXPECT_EQ(news.last, 102U);
  EXPECT_TRUE(ring.after(102).text.empty());
}

TEST(EventRing, StartsAgainWhereItCan) {
  EventRing ring{100};
  ring.append("state", {});
  EXPECT_EQ(ring.nearest(7), 100U);     // Number of an earlier start: all events are returned.
  EXPECT_EQ(ring.nearest(5000), 101U);  // Number of another service: events from now on.
  EXPECT_TRUE(ring.holds_all_after(100));
}

TEST(EventRing, ForgetsByBytes) {
  EventRing ring{0};
  const std::string mebibyte(1024 * 1024, 'x');
  for (int i = 0; i < 20; ++i) {
    ring.append("state", mebibyte);
  }
  EXPECT_FALSE(ring.holds_all_after(1));
  EXPECT_EQ(ring.nearest(0), 5U);
  EXPECT_TRUE(ring.holds_all_after(5));
  // Large events are not returned all at once.
  EXPECT_LT(ring.after(5).text.size(), 2 * mebibyte.size());
}

}  // namespace spindrift::event_ring_test
