#include "services/ingest/sequence_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace spindrift::sequence_tracker_test {

const std::string kSpacecraft = "SPINNER";

Origin origin(std::uint64_t seq, std::uint64_t session = 1, std::string source = "front-end") {
  return {.source = std::move(source), .session = session, .seq = seq};
}

SequenceCounts counts_after(SequenceTracker& tracker, const std::vector<std::uint64_t>& seqs) {
  for (const std::uint64_t seq : seqs) {
    tracker.record(origin(seq), kSpacecraft);
  }
  return tracker.by_source().at("front-end");
}

TEST(SequenceTracker, FindsNothingInOrder) {
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {0, 1, 2, 3}), (SequenceCounts{.received = 4}));
}

TEST(SequenceTracker, CountsEveryMissingSampleOfAGap) {
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {0, 1, 5, 7}), (SequenceCounts{.received = 4, .missing = 4}));
}

TEST(SequenceTracker, FillsTheGapWithALateArrival) {
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {0, 3, 1, 2}), (SequenceCounts{.received = 4, .disordered = 2}));
}

TEST(SequenceTracker, CountsADuplicateOnceMoreEachTime) {
  SequenceTracker tracker;
  EXPECT_EQ(tracker.record(origin(0), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.record(origin(0), kSpacecraft), Arrival::Duplicate);
  EXPECT_EQ(tracker.record(origin(2), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.record(origin(0), kSpacecraft), Arrival::Duplicate);
  EXPECT_EQ(tracker.by_source().at("front-end"),
            (SequenceCounts{.received = 4, .missing = 1, .duplicates = 2}));
}

TEST(SequenceTracker, TakesNoGapBeforeTheFirstSampleSeen) {
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {1000, 1001}), (SequenceCounts{.received = 2}));
}

TEST(SequenceTracker, TakesNoGapAtARestartOfTheSource) {
  SequenceTracker tracker;
  for (const std::uint64_t session : {11U, 12U, 13U}) {
    for (std::uint64_t seq = 0; seq < 10; ++seq) {
      EXPECT_EQ(tracker.record(origin(seq, session), kSpacecraft), Arrival::New);
    }
  }
  EXPECT_EQ(tracker.by_source().at("front-end"), (SequenceCounts{.received = 30}));
}

TEST(SequenceTracker, CountsNoGapAgainOfWhatIsSentAgain) {
  SequenceTracker tracker;
  tracker.go_on(origin(20));
  tracker.go_on(origin(9));
  EXPECT_EQ(counts_after(tracker, {5, 6, 10, 19, 20, 21, 23}),
            (SequenceCounts{.received = 7, .missing = 1}));
}

TEST(SequenceTracker, TakesWhatIsSentAgainToGoOnWhereItWas) {
  SequenceTracker tracker;
  tracker.go_on(origin(20));
  EXPECT_EQ(counts_after(tracker, {19, 23, 24}), (SequenceCounts{.received = 3, .missing = 2}));
  EXPECT_EQ(counts_after(tracker, {21, 22}), (SequenceCounts{.received = 5, .disordered = 2}));
}

TEST(SequenceTracker, TakesNoGapBetweenWhatIsKnownAndWhatIsSentSince) {
  SequenceTracker tracker;
  tracker.go_on(origin(20));
  EXPECT_EQ(counts_after(tracker, {500, 502}), (SequenceCounts{.received = 2, .missing = 1}));
  // The new session has no known predecessor.
  tracker.record(origin(3, 2), kSpacecraft);
  tracker.record(origin(5, 2), kSpacecraft);
  EXPECT_EQ(tracker.by_source().at("front-end"), (SequenceCounts{.received = 4, .missing = 2}));
}

TEST(SequenceTracker, KeepsSourcesOfTheSameSessionNumberApart) {
  SequenceTracker tracker;
  EXPECT_EQ(tracker.record(origin(0, 1, "north"), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.record(origin(0, 1, "south"), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.record(origin(2, 1, "south"), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.by_source().at("north"), (SequenceCounts{.received = 1}));
  EXPECT_EQ(tracker.by_source().at("south"), (SequenceCounts{.received = 2, .missing = 1}));
}

TEST(SequenceTracker, KeepsTheTopicsOfASessionApart) {
  SequenceTracker tracker;
  for (std::uint64_t seq = 0; seq < 10; ++seq) {
    for (const std::size_t topic : {0U, 1U}) {
      EXPECT_EQ(tracker.record(origin(seq), kSpacecraft, topic), Arrival::New);
    }
  }
  tracker.record(origin(12), kSpacecraft, 1);
  EXPECT_EQ(tracker.by_source().at("front-end"), (SequenceCounts{.received = 21, .missing = 2}));
}

TEST(SequenceTracker, TellsOnceWhichSourcesChanged) {
  SequenceTracker tracker;
  tracker.record(origin(0, 1, "north"), kSpacecraft);
  tracker.record(origin(0, 1, "south"), kSpacecraft);
  tracker.record(origin(1, 1, "south"), kSpacecraft);
  using Counts = std::map<std::string, SequenceCounts>;
  EXPECT_EQ(tracker.take_changed(),
            (Counts{{"north", {.received = 1}}, {"south", {.received = 2}}}));
  EXPECT_EQ(tracker.take_changed(), Counts{});
  tracker.record(origin(2, 1, "south"), kSpacecraft);
  EXPECT_EQ(tracker.take_changed(), (Counts{{"south", {.received = 3}}}));
}

TEST(SequenceTracker, TellsOfSourcesCountedTogetherUnderTheirCommonName) {
  SequenceTracker tracker;
  for (std::size_t i = 0; i < SequenceTracker::kMaxSources; ++i) {
    tracker.record(origin(0, 1, "source " + std::to_string(i)), kSpacecraft);
  }
  tracker.take_changed();
  tracker.record(origin(0, 1, "one more"), kSpacecraft);
  EXPECT_THAT(tracker.take_changed(),
              ::testing::ElementsAre(::testing::Key(SequenceTracker::kOtherSources)));
}

TEST(SequenceTracker, CountsAJumpFurtherThanAnyGapAsOneThatIsMissing) {
  constexpr std::uint64_t kWild = ~std::uint64_t{0};
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {10, 11, kWild}), (SequenceCounts{.received = 3, .missing = 1}));
  EXPECT_EQ(counts_after(tracker, {12, 13, 15}), (SequenceCounts{.received = 6, .missing = 3}));
  EXPECT_EQ(tracker.record(origin(15), kSpacecraft), Arrival::Duplicate);
}

TEST(SequenceTracker, CountsTheWholeOfAGapUpToTheFarthestJump) {
  constexpr std::uint64_t kFarthest = SequenceTracker::kFarthestJump;
  SequenceTracker tracker;
  EXPECT_EQ(counts_after(tracker, {0, kFarthest}),
            (SequenceCounts{.received = 2, .missing = kFarthest - 1}));
  EXPECT_EQ(counts_after(tracker, {2 * kFarthest + 1}),
            (SequenceCounts{.received = 3, .missing = kFarthest}));
}

TEST(SequenceTracker, GoesOnWithASessionOfWhichAWildSeqIsStored) {
  SequenceTracker tracker;
  tracker.go_on(origin(~std::uint64_t{0} / 2));
  EXPECT_EQ(counts_after(tracker, {20, 22}), (SequenceCounts{.received = 2, .missing = 1}));
}

TEST(SequenceTracker, HoldsTheLastSeqThereIs) {
  SequenceTracker tracker;
  constexpr std::uint64_t kLast = ~std::uint64_t{0};
  EXPECT_EQ(counts_after(tracker, {kLast, kLast - 2, kLast, kLast - 1}),
            (SequenceCounts{.received = 4, .duplicates = 1, .disordered = 2}));
}

TEST(SequenceTracker, FindsNoDisorderInTwoSpacecraftHandedOverOneAfterTheOther) {
  SequenceTracker tracker;
  for (const std::uint64_t first : {0U, 1U}) {
    for (std::uint64_t seq = first; seq < 3600; seq += 2) {
      EXPECT_EQ(tracker.record(origin(seq), first == 0 ? "NORTH" : "SOUTH"), Arrival::New);
    }
  }
  EXPECT_EQ(tracker.by_source().at("front-end"), (SequenceCounts{.received = 3600}));
}

TEST(SequenceTracker, FindsDisorderWithinEachSpacecraft) {
  SequenceTracker tracker;
  tracker.record(origin(0), "NORTH");
  tracker.record(origin(4), "NORTH");
  tracker.record(origin(1), "SOUTH");
  tracker.record(origin(3), "SOUTH");
  tracker.record(origin(2), "NORTH");
  EXPECT_EQ(tracker.by_source().at("front-end"), (SequenceCounts{.received = 5, .disordered = 1}));
}

TEST(SequenceTracker, TakesTooManySpacecraftForOne) {
  SequenceTracker tracker;
  for (std::uint64_t seq = 0; seq < SequenceTracker::kMaxSpacecraft + 10; ++seq) {
    tracker.record(origin(1000 + seq), "spacecraft " + std::to_string(seq));
  }
  tracker.record(origin(1), "one more");
  EXPECT_EQ(tracker.by_source().at("front-end").disordered, 1U);
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

TEST(SequenceTracker, AgreesWithTheDefinitionOnAnyStream) {
  std::mt19937_64 random{20261120};  // NOLINT(cert-msc51-cpp): the same streams every time.
  for (int stream = 0; stream < 200; ++stream) {
    SCOPED_TRACE(stream);
    SequenceTracker tracker;
    Definition definition;
    const std::uint64_t start = random() % 1000;
    std::uniform_int_distribution<std::uint64_t> jump{0, 1 + random() % 40};
    for (std::uint64_t i = 0; i < 500; ++i) {
      const std::uint64_t seq = start + i + jump(random);
      ASSERT_EQ(tracker.record(origin(seq), kSpacecraft), definition.record(seq));
      ASSERT_EQ(tracker.by_source().at("front-end"), definition.counts);
    }
  }
}

TEST(SequenceTracker, GivesUpTheLowestOfTooManyGapsAndStillCountsThem) {
  SequenceTracker tracker;
  const std::uint64_t count = SequenceTracker::kMaxRuns + 100;
  for (std::uint64_t i = 0; i < count; ++i) {
    tracker.record(origin(2 * i), kSpacecraft);
  }
  EXPECT_EQ(tracker.record(origin(0), kSpacecraft), Arrival::New);
  EXPECT_EQ(tracker.record(origin(2 * (count - 1)), kSpacecraft), Arrival::Duplicate);
  EXPECT_EQ(tracker.by_source().at("front-end"),
            (SequenceCounts{
                .received = count + 2, .missing = count - 1, .duplicates = 1, .disordered = 1}));
}

TEST(SequenceTracker, ForgetsTheSessionSilentForLongest) {
  SequenceTracker tracker;
  for (std::uint64_t session = 0; session < SequenceTracker::kMaxSessions; ++session) {
    tracker.record(origin(0, session), kSpacecraft);
  }
  tracker.record(origin(1, 0), kSpacecraft);
  tracker.record(origin(0, SequenceTracker::kMaxSessions), kSpacecraft);
  EXPECT_EQ(tracker.record(origin(1, 0), kSpacecraft), Arrival::Duplicate);
  EXPECT_EQ(tracker.record(origin(0, 1), kSpacecraft), Arrival::New);
}

TEST(SequenceTracker, CountsTooManySourcesTogether) {
  SequenceTracker tracker;
  for (std::size_t i = 0; i < SequenceTracker::kMaxSources + 10; ++i) {
    tracker.record(origin(0, 1, "source " + std::to_string(i)), kSpacecraft);
  }
  EXPECT_EQ(tracker.by_source().size(), SequenceTracker::kMaxSources + 1);
  EXPECT_EQ(tracker.by_source().at(SequenceTracker::kOtherSources),
            (SequenceCounts{.received = 10}));
}

}  // namespace spindrift::sequence_tracker_test
