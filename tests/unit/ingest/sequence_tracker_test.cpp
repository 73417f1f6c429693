#include "services/ingest/sequence_tracker.h"

#include <random>
#include <set>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::sequence_tracker_test {

Origin origin(std::uint64_t seq, std::uint64_t session = 1, std::string source = "front-end") {
  return {.source = std::move(source), .session = session, .seq = seq};
}

class SequenceTrackerTest : public ::testing::Test {
 protected:
  Arrival record(const Origin& origin, const std::string& spacecraft = "SPINNER",
                 std::size_t topic = 0) {
    return tracker_.record(origin, spacecraft, topic);
  }
  SequenceCounts counts(const std::string& source = "front-end") const {
    return tracker_.by_source().at(source);
  }
  SequenceCounts counts_after(const std::vector<std::uint64_t>& seqs) {
    for (const std::uint64_t seq : seqs) {
      record(origin(seq));
    }
    return counts();
  }

  SequenceTracker tracker_;
};

TEST_F(SequenceTrackerTest, FindsNothingInOrder) {
  EXPECT_EQ(counts_after({0, 1, 2, 3}), (SequenceCounts{.received = 4}));
}

TEST_F(SequenceTrackerTest, CountsEveryMissingSampleOfAGap) {
  EXPECT_EQ(counts_after({0, 1, 5, 7}), (SequenceCounts{.received = 4, .missing = 4}));
}

TEST_F(SequenceTrackerTest, FillsTheGapWithALateArrival) {
  EXPECT_EQ(counts_after({0, 3, 1, 2}), (SequenceCounts{.received = 4, .disordered = 2}));
}

TEST_F(SequenceTrackerTest, CountsADuplicateOnceMoreEachTime) {
  EXPECT_EQ(record(origin(0)), Arrival::New);
  EXPECT_EQ(record(origin(0)), Arrival::Duplicate);
  EXPECT_EQ(record(origin(2)), Arrival::New);
  EXPECT_EQ(record(origin(0)), Arrival::Duplicate);
  EXPECT_EQ(counts(), (SequenceCounts{.received = 4, .missing = 1, .duplicates = 2}));
}

TEST_F(SequenceTrackerTest, TakesNoGapBeforeTheFirstSampleSeen) {
  EXPECT_EQ(counts_after({1000, 1001}), (SequenceCounts{.received = 2}));
}

TEST_F(SequenceTrackerTest, TakesNoGapAtARestartOfTheSource) {
  for (const std::uint64_t session : {11U, 12U, 13U}) {
    for (std::uint64_t seq = 0; seq < 10; ++seq) {
      EXPECT_EQ(record(origin(seq, session)), Arrival::New);
    }
  }
  EXPECT_EQ(counts(), (SequenceCounts{.received = 30}));
}

TEST_F(SequenceTrackerTest, CountsNoGapAgainOfWhatIsSentAgain) {
  tracker_.go_on(origin(20));
  tracker_.go_on(origin(9));
  EXPECT_EQ(counts_after({5, 6, 10, 19, 20, 21, 23}),
            (SequenceCounts{.received = 7, .missing = 1}));
}

TEST_F(SequenceTrackerTest, TakesWhatIsSentAgainToGoOnWhereItWas) {
  tracker_.go_on(origin(20));
  EXPECT_EQ(counts_after({19, 23, 24}), (SequenceCounts{.received = 3, .missing = 2}));
  EXPECT_EQ(counts_after({21, 22}), (SequenceCounts{.received = 5, .disordered = 2}));
}

TEST_F(SequenceTrackerTest, TakesNoGapBetweenWhatIsKnownAndWhatIsSentSince) {
  tracker_.go_on(origin(20));
  EXPECT_EQ(counts_after({500, 502}), (SequenceCounts{.received = 2, .missing = 1}));
  // The new session has no known predecessor.
  record(origin(3, 2));
  record(origin(5, 2));
  EXPECT_EQ(counts(), (SequenceCounts{.received = 4, .missing = 2}));
}

TEST_F(SequenceTrackerTest, KeepsSourcesOfTheSameSessionNumberApart) {
  EXPECT_EQ(record(origin(0, 1, "north")), Arrival::New);
  EXPECT_EQ(record(origin(0, 1, "south")), Arrival::New);
  EXPECT_EQ(record(origin(2, 1, "south")), Arrival::New);
  EXPECT_EQ(counts("north"), (SequenceCounts{.received = 1}));
  EXPECT_EQ(counts("south"), (SequenceCounts{.received = 2, .missing = 1}));
}

TEST_F(SequenceTrackerTest, KeepsTheTopicsOfASessionApart) {
  for (std::uint64_t seq = 0; seq < 10; ++seq) {
    for (const std::size_t topic : {0U, 1U}) {
      EXPECT_EQ(record(origin(seq), "SPINNER", topic), Arrival::New);
    }
  }
  record(origin(12), "SPINNER", 1);
  EXPECT_EQ(counts(), (SequenceCounts{.received = 21, .missing = 2}));
}

TEST_F(SequenceTrackerTest, TellsOnceWhichSourcesChanged) {
  record(origin(0, 1, "north"));
  record(origin(0, 1, "south"));
  record(origin(1, 1, "south"));
  using Counts = std::map<std::string, SequenceCounts>;
  EXPECT_EQ(tracker_.take_changed(),
            (Counts{{"north", {.received = 1}}, {"south", {.received = 2}}}));
  EXPECT_EQ(tracker_.take_changed(), Counts{});
  record(origin(2, 1, "south"));
  EXPECT_EQ(tracker_.take_changed(), (Counts{{"south", {.received = 3}}}));
}

TEST_F(SequenceTrackerTest, TellsOfSourcesCountedTogetherUnderTheirCommonName) {
  for (std::size_t i = 0; i < SequenceTracker::kMaxSources; ++i) {
    record(origin(0, 1, "source " + std::to_string(i)));
  }
  tracker_.take_changed();
  record(origin(0, 1, "one more"));
  EXPECT_THAT(tracker_.take_changed(), ElementsAre(::testing::Key(SequenceTracker::kOtherSources)));
}

TEST_F(SequenceTrackerTest, CountsAJumpFurtherThanAnyGapAsOneThatIsMissing) {
  constexpr std::uint64_t kWild = ~std::uint64_t{0};
  EXPECT_EQ(counts_after({10, 11, kWild}), (SequenceCounts{.received = 3, .missing = 1}));
  EXPECT_EQ(counts_after({12, 13, 15}), (SequenceCounts{.received = 6, .missing = 3}));
  EXPECT_EQ(record(origin(15)), Arrival::Duplicate);
}

TEST_F(SequenceTrackerTest, CountsTheWholeOfAGapUpToTheFarthestJump) {
  constexpr std::uint64_t kFarthest = SequenceTracker::kFarthestJump;
  EXPECT_EQ(counts_after({0, kFarthest}),
            (SequenceCounts{.received = 2, .missing = kFarthest - 1}));
  EXPECT_EQ(counts_after({2 * kFarthest + 1}),
            (SequenceCounts{.received = 3, .missing = kFarthest}));
}

TEST_F(SequenceTrackerTest, GoesOnWithASessionOfWhichAWildSeqIsStored) {
  tracker_.go_on(origin(~std::uint64_t{0} / 2));
  EXPECT_EQ(counts_after({20, 22}), (SequenceCounts{.received = 2, .missing = 1}));
}

TEST_F(SequenceTrackerTest, HoldsTheLastSeqThereIs) {
  constexpr std::uint64_t kLast = ~std::uint64_t{0};
  EXPECT_EQ(counts_after({kLast, kLast - 2, kLast, kLast - 1}),
            (SequenceCounts{.received = 4, .duplicates = 1, .disordered = 2}));
}

TEST_F(SequenceTrackerTest, FindsNoDisorderInTwoSpacecraftHandedOverOneAfterTheOther) {
  for (const std::uint64_t first : {0U, 1U}) {
    for (std::uint64_t seq = first; seq < 3600; seq += 2) {
      EXPECT_EQ(record(origin(seq), first == 0 ? "NORTH" : "SOUTH"), Arrival::New);
    }
  }
  EXPECT_EQ(counts(), (SequenceCounts{.received = 3600}));
}

TEST_F(SequenceTrackerTest, FindsDisorderWithinEachSpacecraft) {
  record(origin(0), "NORTH");
  record(origin(4), "NORTH");
  record(origin(1), "SOUTH");
  record(origin(3), "SOUTH");
  record(origin(2), "NORTH");
  EXPECT_EQ(counts(), (SequenceCounts{.received = 5, .disordered = 1}));
}

TEST_F(SequenceTrackerTest, TakesTooManySpacecraftForOne) {
  for (std::uint64_t seq = 0; seq < SequenceTracker::kMaxSpacecraft + 10; ++seq) {
    record(origin(1000 + seq), "spacecraft " + std::to_string(seq));
  }
  record(origin(1), "one more");
  EXPECT_EQ(counts().disordered, 1U);
}

/// Counts by definition: from the set of all numbers that arrived.
struct Definition {
  std::set<std::uint64_t> seen;
  SequenceCounts counts;

  Arrival record(std::uint64_t seq) {
    ++counts.received;
    const bool late = !seen.empty() && seq < *seen.rbegin();
    const bool is_new = seen.insert(seq).second;
    counts.duplicates += is_new ? 0 : 1;
    counts.disordered += is_new && late ? 1 : 0;
    counts.missing = *seen.rbegin() - *seen.begin() + 1 - seen.size();
    return is_new ? Arrival::New : Arrival::Duplicate;
  }
};

TEST_F(SequenceTrackerTest, AgreesWithTheDefinitionOnAnyStream) {
  std::mt19937_64 random{20261120};  // NOLINT(cert-msc51-cpp): the same streams every time.
  for (int stream = 0; stream < 200; ++stream) {
    SCOPED_TRACE(stream);
    SequenceTracker tracker;
    Definition definition;
    const std::uint64_t start = random() % 1000;
    std::uniform_int_distribution<std::uint64_t> jump{0, 1 + random() % 40};
    for (std::uint64_t i = 0; i < 500; ++i) {
      const std::uint64_t seq = start + i + jump(random);
      ASSERT_EQ(tracker.record(origin(seq), "SPINNER"), definition.record(seq));
      ASSERT_EQ(tracker.by_source().at("front-end"), definition.counts);
    }
  }
}

TEST_F(SequenceTrackerTest, GivesUpTheLowestOfTooManyGapsAndStillCountsThem) {
  const std::uint64_t count = SequenceTracker::kMaxRuns + 100;
  for (std::uint64_t i = 0; i < count; ++i) {
    record(origin(2 * i));
  }
  EXPECT_EQ(record(origin(0)), Arrival::New);
  EXPECT_EQ(record(origin(2 * (count - 1))), Arrival::Duplicate);
  EXPECT_EQ(counts(),
            (SequenceCounts{
                .received = count + 2, .missing = count - 1, .duplicates = 1, .disordered = 1}));
}

TEST_F(SequenceTrackerTest, ForgetsTheSessionSilentForLongest) {
  for (std::uint64_t session = 0; session < SequenceTracker::kMaxSessions; ++session) {
    record(origin(0, session));
  }
  record(origin(1, 0));
  record(origin(0, SequenceTracker::kMaxSessions));
  EXPECT_EQ(record(origin(1, 0)), Arrival::Duplicate);
  EXPECT_EQ(record(origin(0, 1)), Arrival::New);
}

TEST_F(SequenceTrackerTest, CountsTooManySourcesTogether) {
  for (std::size_t i = 0; i < SequenceTracker::kMaxSources + 10; ++i) {
    record(origin(0, 1, "source " + std::to_string(i)));
  }
  EXPECT_EQ(tracker_.by_source().size(), SequenceTracker::kMaxSources + 1);
  EXPECT_EQ(tracker_.by_source().at(SequenceTracker::kOtherSources),
            (SequenceCounts{.received = 10}));
}

}  // namespace spindrift::sequence_tracker_test
