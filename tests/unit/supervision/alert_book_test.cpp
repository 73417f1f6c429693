#include "pipelines/supervision/alert_book.h"

#include "tests/support/matchers.h"

namespace spindrift::alert_book_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

Occurrence occurrence(double t_s) {
  return {.run_id = "run-1",
          .key = "spin.sigma",
          .severity = AlertSeverity::Warning,
          .t = at(t_s),
          .message = "sigma",
          .evidence = "{}"};
}

struct RaisedBook {
  AlertBook book;
  std::string id = book.raise(occurrence(1)).value().alert_id;
};

TEST(AlertBook, HasOneOpenAlertAKeyAndANewOneAfterItWasCleared) {
  AlertBook book;
  EXPECT_FALSE(book.clear(occurrence(0)));
  const Alert raised = book.raise(occurrence(1)).value();
  EXPECT_EQ(raised.state, AlertState::Active);
  EXPECT_EQ(raised.revision, 1);
  EXPECT_LE(raised.alert_id.size(), 40U);
  EXPECT_FALSE(book.raise(occurrence(2)));
  const Alert cleared = book.clear(occurrence(3)).value();
  EXPECT_EQ(cleared.alert_id, raised.alert_id);
  EXPECT_EQ(cleared.from, AlertState::Active);
  EXPECT_EQ(cleared.state, AlertState::Cleared);
  EXPECT_EQ(cleared.cleared, at(3));
  EXPECT_EQ(cleared.revision, 2);
  EXPECT_TRUE(book.open().empty());
  const Alert again = book.raise(occurrence(4)).value();
  EXPECT_NE(again.alert_id, raised.alert_id);
  EXPECT_EQ(again.count, 2);
}

TEST(AlertBook, KnowsWhatIsComputedAgain) {
  RaisedBook once;
  const Alert cleared = once.book.clear(occurrence(3)).value();
  AlertBook restarted;
  restarted.take_up("run-1", cleared);
  EXPECT_FALSE(restarted.raise(occurrence(1)));
  EXPECT_FALSE(restarted.clear(occurrence(3)));
  EXPECT_TRUE(restarted.raise(occurrence(5)));

  AlertBook open;
  open.take_up("run-1", RaisedBook{}.book.open().front());
  EXPECT_FALSE(open.clear(occurrence(0)));
  EXPECT_FALSE(open.raise(occurrence(1)));
  EXPECT_TRUE(open.clear(occurrence(2)));
}

TEST(AlertBook, RaisesAndClearsInALaterRunOfEarlierTelemetry) {
  const auto later_run = [](double t_s) {
    Occurrence one = occurrence(t_s);
    one.run_id = "run-2";
    return one;
  };
  RaisedBook open;
  EXPECT_FALSE(open.book.raise(later_run(-100)));
  const Alert cleared = open.book.clear(later_run(-90)).value();
  EXPECT_EQ(cleared.cleared, cleared.raised);

  RaisedBook over;
  ASSERT_TRUE(over.book.clear(occurrence(3)));
  EXPECT_EQ(over.book.raise(later_run(-100)).value().count, 2);
  EXPECT_FALSE(over.book.clear(later_run(-100)));
  EXPECT_TRUE(over.book.clear(later_run(-90)));
}

TEST(AlertBook, TakesUpTheLastOfAKeyWhateverItsTime) {
  RaisedBook first;
  const Alert cleared = first.book.clear(occurrence(3)).value();
  Alert later = RaisedBook{}.book.open().front();
  later.alert_id = "later";
  later.raised = at(-100);
  AlertBook restarted;
  restarted.take_up("run-1", cleared);
  restarted.take_up("run-2", later);
  ASSERT_EQ(restarted.open().size(), 1U);
  EXPECT_EQ(restarted.open().front().alert_id, "later");
}

TEST(AlertBook, SaysWhenAChangeIsNewWhateverTheClock) {
  RaisedBook raised;
  EXPECT_EQ(raised.book.after("spin.rate", at(0)), at(0));
  EXPECT_EQ(raised.book.after("spin.sigma", at(2)), at(2));
  EXPECT_FALSE(raised.book.clear(occurrence(0)));
  Occurrence set_back = occurrence(0);
  set_back.t = raised.book.after("spin.sigma", at(0));
  EXPECT_TRUE(raised.book.clear(set_back));
}

TEST(AlertBook, GivesTheSameOccurrenceTheSameId) {
  EXPECT_EQ(RaisedBook{}.id, RaisedBook{}.id);
  AlertBook book;
  EXPECT_NE(book.raise(occurrence(2)).value().alert_id, RaisedBook{}.id);
}

TEST(AlertBook, IsAcknowledgedOnceAndClearedAfterwards) {
  RaisedBook raised;
  const Alert acknowledged =
      raised.book.acknowledge(raised.id, at(2), "night shift", "seen").value();
  EXPECT_EQ(acknowledged.state, AlertState::Acknowledged);
  EXPECT_EQ(acknowledged.by, "night shift");
  EXPECT_EQ(acknowledged.note, "seen");
  EXPECT_FALSE(raised.book.acknowledge(raised.id, at(3), "night shift", "seen"));
  EXPECT_EQ(raised.book.open().size(), 1U);
  EXPECT_EQ(raised.book.clear(occurrence(4)).value().from, AlertState::Acknowledged);
  EXPECT_THAT(raised.book.acknowledge(raised.id, at(5), "night shift", "seen"),
              IsRefused(ErrorCode::InvalidInput, "no alert '" + raised.id + "' is open"));
}

TEST(AlertBook, IsActiveAgainWhenItsShelvingIsOver) {
  RaisedBook raised;
  const Alert shelved = raised.book.shelve(raised.id, at(2), at(10), "shift", "later").value();
  EXPECT_EQ(shelved.state, AlertState::Shelved);
  EXPECT_EQ(shelved.shelved_until, at(10));
  EXPECT_TRUE(raised.book.expire(at(9)).empty());
  const auto expired = raised.book.expire(at(10));
  ASSERT_EQ(expired.size(), 1U);
  EXPECT_EQ(expired.front().state, AlertState::Active);
  EXPECT_FALSE(expired.front().shelved_until);
  EXPECT_EQ(expired.front().revision, 3);
}

}  // namespace spindrift::alert_book_test
