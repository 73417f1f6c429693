#include "services/serving/session_watch.h"

#include <gtest/gtest.h>

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

TEST(SessionWatch, CountsSessionsAndWhatTheyBringAgain) {
  SessionWatch sessions;
  sessions.note(batch("front-end", 1, 0.0, 10));
  SourceRecord record = sessions.report("SPINNER", {}).at("front-end");
  EXPECT_EQ(record.restarts, 0);
  EXPECT_EQ(record.repeated, 0);
  sessions.note(batch("front-end", 2, 5.0, 10));
  record = sessions.report("SPINNER", {}).at("front-end");
  EXPECT_EQ(record.restarts, 1);
  EXPECT_EQ(record.repeated, 5);
  EXPECT_EQ(sessions.samples(), 20U);
  EXPECT_TRUE(sessions.report("OTHER", {}).empty());
}

TEST(SessionWatch, DoesNotTakeTwoThatSendTheSameForRepetition) {
  SessionWatch sessions;
  sessions.note(batch("front-end", 1, 0.0, 10));
  for (int i = 10; i < 20; ++i) {
    sessions.note(batch("front-end", 1, i, 1));
    sessions.note(batch("standby", 7, i, 1));
  }
  EXPECT_EQ(sessions.report("SPINNER", {}).at("standby").repeated, 1);
  EXPECT_EQ(sessions.report("SPINNER", {}).at("front-end").restarts, 0);
}

TEST(SessionWatch, TellsOfAGapTheSpacecraftThatTheSourceBrings) {
  SessionWatch sessions;
  LastOrigins origins;
  origins[kTelemetryKind<Pulse>] = {{.source = "front-end", .session = 1, .seq = 9}};
  sessions.go_on("OTHER", origins, at(9.0));
  sessions.note(batch("front-end", 1, 0.0, 10));
  const std::map<std::string, std::uint64_t> missing{{"front-end", 3}, {"of-others", 5}};
  EXPECT_EQ(sessions.report("SPINNER", missing).size(), 1U);
  EXPECT_EQ(sessions.report("SPINNER", missing).at("front-end").missing, 3);
  EXPECT_EQ(sessions.report("OTHER", missing).at("front-end").missing, 0);
}

TEST(SessionWatch, KnowsTheSessionsOfBeforeARestart) {
  SessionWatch sessions;
  LastOrigins origins;
  origins[kTelemetryKind<Pulse>] = {{.source = "front-end", .session = 1, .seq = 9}};
  sessions.go_on("SPINNER", origins, at(9.0));
  sessions.note(batch("front-end", 1, 5.0, 10));
  EXPECT_EQ(sessions.report("SPINNER", {}).at("front-end").restarts, 0);
  EXPECT_EQ(sessions.report("SPINNER", {}).at("front-end").repeated, 0);
  sessions.note(batch("front-end", 2, 5.0, 10));
  EXPECT_EQ(sessions.report("SPINNER", {}).at("front-end").restarts, 1);
  EXPECT_EQ(sessions.report("SPINNER", {}).at("front-end").repeated, 10);
}

}  // namespace spindrift::session_watch_test
