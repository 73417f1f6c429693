#include "pipelines/supervision/alert_book.h"

#include <set>
#include <string>
#include <vector>

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

/// Returns an occurrence that had to hold for `took_s` before `t_s`, with the default hold-off.
Occurrence held(double t_s, double took_s = 0.0) {
  Occurrence one = occurrence(t_s);
  one.took_s = took_s;
  one.hold_off_s = 60.0;
  return one;
}

TEST(AlertBook, OpensTheSameAlertAgainWithinItsHoldOff) {
  RaisedBook raised;
  ASSERT_TRUE(raised.book.clear(held(10)));
  const Alert returned = raised.book.raise(held(69.999)).value();
  EXPECT_EQ(returned.alert_id, raised.id);
  EXPECT_EQ(returned.from, AlertState::Cleared);
  EXPECT_EQ(returned.state, AlertState::Active);
  EXPECT_EQ(returned.raised, at(1));
  EXPECT_EQ(returned.returned, at(69.999));
  EXPECT_FALSE(returned.cleared);
  EXPECT_EQ(returned.count, 2);
  EXPECT_EQ(returned.revision, 3);

  ASSERT_TRUE(raised.book.clear(held(80)));
  const Alert next = raised.book.raise(held(140.001)).value();
  EXPECT_NE(next.alert_id, raised.id);
  EXPECT_FALSE(next.from);
  EXPECT_FALSE(next.returned);
  EXPECT_EQ(next.count, 3);
  EXPECT_EQ(next.revision, 1);
}

TEST(AlertBook, HoldsOffTenTimesWhatRaisingTook) {
  const auto returns_after = [](double gap_s) {
    RaisedBook raised;
    EXPECT_TRUE(raised.book.clear(held(100)));
    // It begins at the end of the gap and is raised 30 s later.
    return raised.book.raise(held(100 + gap_s + 30, 30)).value().alert_id == raised.id;
  };
  EXPECT_TRUE(returns_after(299.9));
  EXPECT_FALSE(returns_after(300.1));
}

TEST(AlertBook, CountsAConditionThatFlapsAsOneOccurrence) {
  AlertBook book;
  std::set<std::string> ids;
  for (int i = 0; i < 150; ++i) {
    ids.insert(book.raise(held(4 * i)).value().alert_id);
    ASSERT_TRUE(book.clear(held(4 * i + 2)));
  }
  EXPECT_EQ(ids.size(), 1U);
  EXPECT_EQ(book.count_of("spin.sigma"), 150);
}

TEST(AlertBook, KnowsAfterARestartWhatReturned) {
  RaisedBook raised;
  ASSERT_TRUE(raised.book.clear(held(10)));
  AlertBook restarted;
  restarted.take_up("run-1", raised.book.raise(held(20)).value());
  EXPECT_FALSE(restarted.clear(held(0)));
  EXPECT_FALSE(restarted.raise(held(1)));
  EXPECT_FALSE(restarted.clear(held(10)));
  EXPECT_FALSE(restarted.raise(held(20)));
  ASSERT_EQ(restarted.open().size(), 1U);
  EXPECT_EQ(restarted.open().front().count, 2);
  const Alert cleared = restarted.clear(held(30)).value();
  AlertBook again;
  again.take_up("run-1", cleared);
  EXPECT_EQ(again.raise(held(40)).value().alert_id, raised.id);
}

TEST(AlertBook, StaysAcknowledgedWhenItReturns) {
  RaisedBook raised;
  ASSERT_TRUE(raised.book.acknowledge(raised.id, at(2), "shift", "seen"));
  ASSERT_TRUE(raised.book.clear(held(10)));
  const Alert returned = raised.book.raise(held(20)).value();
  EXPECT_EQ(returned.state, AlertState::Acknowledged);
  EXPECT_EQ(returned.accepted->by, "shift");
  EXPECT_EQ(returned.accepted->t, at(2));
  ASSERT_TRUE(raised.book.clear(held(30)));
  EXPECT_EQ(raised.book.raise(held(100)).value().state, AlertState::Active);
}

TEST(AlertBook, StaysShelvedOverAClearAndAnotherOccurrenceUntilItsTimeIsUp) {
  RaisedBook raised;
  ASSERT_TRUE(raised.book.shelve(raised.id, at(2), at(1000), "shift", "later"));
  const Alert cleared = raised.book.clear(held(10)).value();
  EXPECT_EQ(cleared.state, AlertState::Cleared);
  EXPECT_EQ(cleared.shelved_until, at(1000));
  AlertBook restarted;
  restarted.take_up("run-1", cleared);
  const Alert next = restarted.raise(held(500)).value();
  EXPECT_NE(next.alert_id, raised.id);
  EXPECT_EQ(next.state, AlertState::Shelved);
  EXPECT_TRUE(restarted.expire(at(999)).empty());
  ASSERT_EQ(restarted.expire(at(1000)).size(), 1U);
  ASSERT_TRUE(restarted.clear(held(1010)));
  EXPECT_EQ(restarted.raise(held(1020)).value().state, AlertState::Active);
}

TEST(AlertBook, IsShelvedNoMoreWhenTheTimeIsUpWhileItIsCleared) {
  RaisedBook raised;
  ASSERT_TRUE(raised.book.shelve(raised.id, at(2), at(30), "shift", "later"));
  ASSERT_TRUE(raised.book.clear(held(10)));
  EXPECT_TRUE(raised.book.expire(at(30)).empty());
  EXPECT_EQ(raised.book.raise(held(40)).value().state, AlertState::Active);
}

TEST(AlertBook, RenewsTheMessageOfAnOpenAlertOnly) {
  RaisedBook raised;
  Occurrence worse = held(20);
  worse.message = "sigma 2";
  EXPECT_FALSE(AlertBook{}.renew(worse));
  const Alert renewed = raised.book.renew(worse).value();
  EXPECT_EQ(renewed.message, "sigma 2");
  EXPECT_EQ(renewed.state, AlertState::Active);
  EXPECT_EQ(renewed.revision, 2);
  EXPECT_EQ(renewed.by, "");
  ASSERT_TRUE(raised.book.clear(held(30)));
  EXPECT_FALSE(raised.book.renew(held(40)));
}

/// Flaps ten times a second for `end_s`; returns the changes that were given.
std::vector<Alert> flapped(AlertBook& book, int end_s) {
  std::vector<Alert> given;
  for (int i = 0; i < 10 * end_s; ++i) {
    const auto alert = i % 2 == 0 ? book.raise(held(0.1 * i)) : book.clear(held(0.1 * i));
    if (alert) {
      given.push_back(*alert);
    }
  }
  return given;
}

TEST(AlertBook, GivesOnlyHalfOfTheMostAnHourToWhatReturns) {
  AlertBook book;
  const auto given = flapped(book, 3599);
  EXPECT_EQ(given.size(), AlertBook::kMostAnHour / 2);
  Occurrence other = held(3599);
  other.key = "spin.rate";
  EXPECT_TRUE(book.raise(other));
  EXPECT_TRUE(book.catch_up(at(3599)).empty());
  const auto late = book.catch_up(at(3660));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(late.front().alert_id, given.front().alert_id);
  EXPECT_EQ(late.front().state, AlertState::Cleared);
  EXPECT_EQ(late.front().from, given.back().state);
  EXPECT_EQ(late.front().count, 3599 * 5);
  EXPECT_THAT(late.front().note, HasSubstr("35489 changes before it are left out"));
}

TEST(AlertBook, GivesAtMostAThousandChangesAnHour) {
  AlertBook book;
  std::size_t given = 0;
  for (int i = 0; i < 2000; ++i) {
    Occurrence one = held(i);
    one.key = "link.restarted:" + std::to_string(i);
    given += book.raise(one) ? 1 : 0;
  }
  EXPECT_EQ(given, AlertBook::kMostAnHour);
  EXPECT_EQ(book.open().size(), 2000U);
}

TEST(AlertBook, AnEndThatWasNotGivenKeepsTheOccurrence) {
  AlertBook book;
  const auto given = flapped(book, 600);
  Occurrence much_later = held(3599);
  EXPECT_FALSE(book.raise(much_later));
  EXPECT_EQ(book.open().front().alert_id, given.front().alert_id);
}

}  // namespace spindrift::alert_book_test
