#include "services/serving/session_watch.h"

#include "tests/support/matchers.h"

namespace spindrift::session_watch_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

ArchiveBatch batch(const std::string& source, std::uint64_t session, double from_s, int samples) {
  ArchiveBatch batch{.run_id = "run", .spacecraft_id = "SPINNER"};
  for (int i = 0; i < samples; ++i) {
    batch.samples.of<Pulse>().push_back(
        {.spacecraft = "SPINNER",
         .origin = {.source = source, .session = session, .seq = static_cast<std::uint64_t>(i)},
         .value = {.t = at(from_s + i), .channel = PulseChannel::Sun1}});
  }
  return batch;
}

LastOrigins front_end_before() {
  LastOrigins origins;
  origins[kTelemetryKind<Pulse>] = {{.source = "front-end", .session = 1, .seq = 9}};
  return origins;
}

class SessionWatchTest : public ::testing::Test {
 protected:
  /// Expects how often the front-end restarted and how many samples it repeated.
  void expect_counts(std::int64_t restarts, std::int64_t repeated) const {
    const SourceRecord record = sessions_.report("SPINNER", {}).at("front-end");
    EXPECT_EQ(record.restarts, restarts);
    EXPECT_EQ(record.repeated, repeated);
  }

  SessionWatch sessions_;
};

TEST_F(SessionWatchTest, CountsSessionsAndWhatTheyBringAgain) {
  sessions_.follow(batch("front-end", 1, 0.0, 10));
  expect_counts(0, 0);
  sessions_.follow(batch("front-end", 2, 5.0, 10));
  expect_counts(1, 5);
  EXPECT_EQ(sessions_.samples(), 20U);
  EXPECT_TRUE(sessions_.report("OTHER", {}).empty());
}

TEST_F(SessionWatchTest, DoesNotTakeTwoThatSendTheSameForRepetition) {
  sessions_.follow(batch("front-end", 1, 0.0, 10));
  for (int i = 10; i < 20; ++i) {
    sessions_.follow(batch("front-end", 1, i, 1));
    sessions_.follow(batch("standby", 7, i, 1));
  }
  EXPECT_EQ(sessions_.report("SPINNER", {}).at("standby").repeated, 1);
  EXPECT_EQ(sessions_.report("SPINNER", {}).at("front-end").restarts, 0);
}

TEST_F(SessionWatchTest, TellsOfAGapTheSpacecraftThatTheSourceBrings) {
  sessions_.go_on("OTHER", front_end_before(), at(9.0));
  sessions_.follow(batch("front-end", 1, 0.0, 10));
  const std::map<std::string, std::uint64_t> missing{{"front-end", 3}, {"of-others", 5}};
  EXPECT_EQ(sessions_.report("SPINNER", missing).size(), 1U);
  EXPECT_EQ(sessions_.report("SPINNER", missing).at("front-end").missing, 3);
  EXPECT_EQ(sessions_.report("OTHER", missing).at("front-end").missing, 0);
}

TEST_F(SessionWatchTest, KnowsTheSessionsOfBeforeARestart) {
  sessions_.go_on("SPINNER", front_end_before(), at(9.0));
  sessions_.follow(batch("front-end", 1, 5.0, 10));
  expect_counts(0, 0);
  sessions_.follow(batch("front-end", 2, 5.0, 10));
  expect_counts(1, 10);
}

}  // namespace spindrift::session_watch_test
