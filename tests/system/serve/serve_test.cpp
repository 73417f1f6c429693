// `spindrift serve` fed by `spindrift replay`: real processes, DDS and archive.

#include <spindrift.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "services/publisher/product_messages.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/exact_mission.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/service.h"
#include "tests/support/subscriber.h"

namespace spindrift::serve_test {

using namespace std::chrono_literals;

TEST(Serve, GivesTheRowsOfProcessBitForBitAndCountsWhatItsSourceSent) {
  ReadyService service{"gms5"};
  ASSERT_TRUE(service.serves_its_pass()) << service.log();

  const Processed processed{"gms5"};
  const auto& offline = processed.db;
  const auto rows = product_rows(offline);
  EXPECT_GT(rows.size(), 15000U);
  EXPECT_EQ(product_rows(service.db()), rows);
  EXPECT_EQ(last_batch_rows(service.db()), last_batch_rows(offline));
  // The number of periodic solutions before the stop depends on the machine; the restart tests
  // check that the next start makes the others.
  EXPECT_EQ(count_rows(offline, "spin_batch"), 1);

  const auto& edges = processed.run["edges_received"];
  EXPECT_THAT(rows_of(service.db(),
                      "SELECT source, received, gaps, duplicates, disordered FROM source_count"),
              ElementsAre("replay|" + edges.dump() + "|0|0|0|"));
  EXPECT_EQ(service.summary()["runs"][0]["edges_received"], edges);
}

// Single edges and bursts are computed on different threads, and processing moves between them.
TEST(Serve, GivesTheRowsOfProcessWhetherEdgesComeOneByOneOrInBursts) {
  const Processed processed{"gms5"};
  const auto& offline = processed.db;
  ReadyService service{"gms5"};
  FrontEnd front_end{service.bus(), "GMS-5", pulses_in(offline)};
  constexpr int kParts = 12;
  for (int part = 0; part < kParts; ++part) {
    ASSERT_TRUE(front_end.send_until((part + 0.6) / kParts));
    ASSERT_TRUE(front_end.send_until((part + 1.0) / kParts, 300us));
  }
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
  EXPECT_EQ(product_rows(service.db()), product_rows(offline));
}

TEST(Serve, PublishesItsResultsForThoseWhoComeLater) {
  ReadyService service{"nominal"};
  ASSERT_EQ(service.replay("0"), 0);
  const Subscriber estimates{service.bus(), product_topic<SpinEstimate>()};
  const Subscriber health{service.bus(), bus::kHealthTopic};

  // Keep the latest estimate of each estimator; more of `batch` may follow.
  std::map<std::string, spindrift_SpinEstimate> latest;
  ASSERT_TRUE(eventually([&] {
    estimates.take([&](const spindrift_SpinEstimate& estimate) {
      latest.insert_or_assign(estimate.estimator, estimate);
    });
    return latest.size() == 3;
  }));
  std::vector<spindrift_Health> beats;
  std::vector<spindrift_SpacecraftHealth> links;
  ASSERT_TRUE(eventually([&] {
    health.take([&](const spindrift_Health& beat) {
      beats.push_back(beat);
      links.push_back(beat.spacecraft._buffer[0]);
    });
    return !beats.empty() && beats.back().samples_committed == 3600;
  }));
  EXPECT_STREQ(links.back().spacecraft, "SPINNER");
  EXPECT_NE(links.back().link, spindrift_LINK_WAITING);
  EXPECT_EQ(links.back().last_sample_tai_ns,
            number_of(service.db(), "SELECT max(t_tai_ns) FROM pulse"));
  EXPECT_STREQ(beats.back().status, "ok");
  EXPECT_EQ(beats.back().samples_received, 3600U);
  ASSERT_EQ(service.stop(), 0) << service.log();

  EXPECT_THAT(service.log(), HasSubstr("SPINNER: axis RA "));
  for (const std::string estimator : {"mean", "sequential", "batch"}) {
    ASSERT_TRUE(latest.contains(estimator)) << estimator;
  }
  for (const auto& [estimator, estimate] : latest) {
    EXPECT_STREQ(estimate.spacecraft, "SPINNER");
    EXPECT_EQ(std::vector{std::string{estimate.run_id} + "|"},
              rows_of(service.db(), "SELECT run_id FROM run"));
    EXPECT_THAT(estimate.service, StartsWith("spindrift "));
    // The announced values must equal the stored ones.
    EXPECT_EQ(real_of(service.db(), "SELECT ra_deg FROM spin_estimate WHERE estimator = '" +
                                        std::string{estimate.estimator} +
                                        "' AND t_tai_ns = " + std::to_string(estimate.t_tai_ns)),
              estimate.ra_deg);
  }
}

TEST(Serve, HasAReplayedSampleAsSoonAsItIsDue) {
  ReadyService service{"nominal"};
  // At this speed the second edge is due after a minute.
  Program replay{service.words({"replay", "--telemetry", kPasses / "nominal", "--speed", "0.001"})};
  EXPECT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") == 1; }));
  replay.signal(SIGTERM);
  EXPECT_EQ(replay.exit_status(), 1);
  ASSERT_EQ(service.stop(), 0) << service.log();
}

TEST(Serve, StoresAnEdgeOnceHoweverOftenItArrives) {
  ReadyService service{"nominal"};
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();

  EXPECT_EQ(count_rows(service.db(), "pulse"), 3600);
  EXPECT_EQ(count_rows(service.db(), "pulse_use WHERE rejected_by = 'late'"), 0);
  EXPECT_EQ(number_of(service.db(), "SELECT max(revolution) FROM revolution"), 599);
}

TEST(Serve, StoresWhatCannotBeTrueWithItsReason) {
  ReadyService service{"nominal"};
  FrontEnd front_end{service.bus(),
                     "SPINNER",
                     {{.t = tai_from_ns(-1), .channel = PulseChannel::Sun1},
                      {.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::Sun1}}};
  ASSERT_TRUE(front_end.send_until(1.0));
  ASSERT_EQ(service.stop(), 0) << service.log();

  EXPECT_THAT(rows_of(service.db(), "SELECT source, line, reason FROM rejected_input"),
              ElementsAre(HasSubstr("front-end|0|")));
  EXPECT_EQ(count_rows(service.db(), "pulse"), 1);
}

TEST(Serve, LeavesTheSpacecraftOfOthersAlone) {
  ReadyService service{"nominal"};
  const auto participant = bus::Participant::create(service.bus()).value();
  auto front_end = TelemetryPublisher<Pulse>::create(participant, "front-end").value();
  ASSERT_TRUE(front_end.wait_for_subscriber(30s));
  constexpr std::int64_t kPairs = 1000;
  for (std::int64_t i = 0; i < kPairs; ++i) {
    const Pulse pulse{.t = tai_from_ns(kTestTime_tai_ns + i * 1'000'000'000),
                      .channel = PulseChannel::Sun1};
    ASSERT_TRUE(front_end.publish("SPINNER", pulse, std::stop_token{}));
    ASSERT_TRUE(front_end.publish("OTHER", pulse, std::stop_token{}));
  }
  ASSERT_TRUE(front_end.wait_for_acknowledgments(30s));
  ASSERT_EQ(service.stop(), 0) << service.log();

  EXPECT_EQ(service.summary()["other_spacecraft"], (nlohmann::json{{"OTHER", kPairs}}));
  EXPECT_EQ(count_rows(service.db(), "pulse"), kPairs);
  EXPECT_EQ(count_rows(service.db(), "rejected_input"), 0);
  EXPECT_THAT(rows_of(service.db(),
                      "SELECT source, received, gaps, duplicates, disordered FROM source_count"),
              ElementsAre("front-end|2000|0|0|0|"));
  expect_said_once(service.program().log(), "'OTHER'");
}

TEST(Serve, SaysThatTheHostsClockDiffersAndAtTheEndWhichEstimatorsDisagree) {
  const PassCopy pass{"nominal"};
  pass.replace("mount_angle_deg = 85", "mount_angle_deg = 86");
  pass.append(kExactSpin);
  ReadyService service{pass.folder.path().string()};
  ASSERT_TRUE(service.serves_its_pass()) << service.log();
  const std::string log = service.log();
  const std::string of_first_start = log.substr(0, log.find("stopping"));
  expect_said_once(of_first_start, "and the clock of this host");
  EXPECT_THAT(log, HasSubstr("SPINNER: sequential and batch disagree"));
  EXPECT_EQ(service.summary()["runs"][0]["disagreements"][0]["other"], "batch");
}

TEST(Serve, CallsItsRunAReplayInThatPartition) {
  ReadyService service{"nominal", "replay"};
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_THAT(
      rows_of(service.db(), "SELECT mode, telemetry FROM run JOIN run_telemetry USING (run_id)"),
      ElementsAre("replay|DDS domain " + std::to_string(service.bus().domain) +
                  ", partition replay|"));
}

TEST(Serve, StopsAcceptingLoudlyWhenTheDiskIsFullAndEndsWithOne) {
  ReadyService service{"gms5", "", 600};
  Program replay{service.words({"replay", "--telemetry", kPasses / "gms5", "--speed", "0"})};
  ASSERT_TRUE(service.program().says("the archive does not store")) << service.log();
  // A late subscriber learns it from the bus, a reader from the log.
  const Subscriber health{service.bus(), bus::kHealthTopic};
  // The archive's path alone fills the status, so the reason is in the message.
  EXPECT_TRUE(eventually([&] {
    std::string message;
    health.take([&](const spindrift_Health& beat) { message = beat.message; });
    return message.starts_with("not storing: ") &&
           message.find("(SQLite code ") != std::string::npos;
  }));
  EXPECT_TRUE(service.program().says("the archive still does not store"));
  EXPECT_THAT(service.log(), Not(HasSubstr("no telemetry")));
  EXPECT_EQ(service.stop(), 1);
  EXPECT_THAT(service.log(), HasSubstr("rows that were accepted are not in archive"));
  replay.signal(SIGKILL);

  // What is stored is consistent: samples and products of each batch together.
  EXPECT_THAT(rows_of(service.db(), "PRAGMA integrity_check"), ElementsAre("ok|"));
  EXPECT_EQ(count_rows(service.db(),
                       "pulse_use LEFT JOIN pulse USING (spacecraft_id, t_tai_ns, channel) WHERE "
                       "pulse.t_tai_ns IS NULL"),
            0);
}

TEST(Serve, NamesAWriterWhoseQosDoesNotDo) {
  ReadyService service{"nominal"};
  const ForeignWriter weak{service.bus(), "weak", 1};
  ASSERT_TRUE(service.program().says("BEST_EFFORT")) << service.log();
  EXPECT_THAT(service.log(), HasSubstr("pid " + std::to_string(weak.pid())));
  ASSERT_EQ(service.stop(), 0) << service.log();
}

TEST(Serve, RefusesTwoMissionsOfOneSpacecraftAndTellsOfAllBadFilesAtOnce) {
  const TemporaryFolder folder;
  const std::string good = (kPasses / "nominal" / "mission.toml").string();
  const auto bad = folder.write("bad.toml", "[spacecraft]\nid = \"BAD\"\n");
  const auto worse = folder.write("worse.toml", "not a mission file");
  const auto db = folder.path() / "out.db";
  refused({"serve", "--mission", good, good, "--db", db}, {"SPINNER"});
  refused({"serve", "--mission", good, bad, worse, "--db", db}, {"bad.toml", "worse.toml"});
  EXPECT_FALSE(std::filesystem::exists(db));
}

TEST(Serve, GivesEachOfSeveralMissionsTheRowsOfItsOwnService) {
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  const std::vector<std::string> passes{"gms5", "nominal"};
  const auto mission = [](const std::string& pass) {
    return (kPasses / pass / "mission.toml").string();
  };
  const auto db = folder.path() / "all.db";
  serve_whole(on(bus, {"serve", "--mission", mission(passes[0]), mission(passes[1]), "--db", db}),
              [&] {
                for (const std::string& pass : passes) {
                  succeeded(on(bus, {"replay", "--mission", mission(pass), "--telemetry",
                                     kPasses / pass, "--speed", "0"}));
                }
              });

  for (const std::string& pass : passes) {
    const Processed processed{pass};
    const auto& alone = processed.db;
    const std::string spacecraft = rows_of(alone, "SELECT spacecraft_id FROM run").at(0);
    const std::string query =
        "SELECT t_tai_ns, ra_deg, dec_deg, sigma_deg, spin_rate_rpm FROM spin_estimate JOIN run "
        "USING (run_id) WHERE spacecraft_id = '" +
        spacecraft.substr(0, spacecraft.size() - 1) +
        "' AND estimator <> 'batch' ORDER BY 1, estimator";
    EXPECT_GT(rows_of(alone, query).size(), 500U);
    EXPECT_EQ(rows_of(db, query), rows_of(alone, query));
  }
}

TEST(Serve, CountsASourceOnceForAllItsMissions) {
  const PassCopy other{"nominal"};
  other.replace("SPINNER", "SECOND");
  const std::string first = (kPasses / "nominal" / "mission.toml").string();
  const std::string second = other.mission();
  const auto& db = other.db;
  const bus::BusConfig bus = bus_of_its_own();
  Serving service{on(bus, {"serve", "--mission", first, second, "--db", db})};
  for (const std::string& mission : {first, second}) {
    succeeded(on(
        bus, {"replay", "--mission", mission, "--telemetry", kPasses / "nominal", "--speed", "0"}));
  }
  stop_in_order(service);

  EXPECT_EQ(count_rows(db, "pulse"), 7200);
  EXPECT_THAT(rows_of(db,
                      "SELECT spacecraft_id, source, received, gaps, disordered FROM source_count "
                      "JOIN run USING (run_id)"),
              ElementsAre("SPINNER|replay|7200|0|0|"));
}

TEST(Replay, GivesUpWhenNobodySubscribes) {
  const bus::BusConfig bus = bus_of_its_own();
  refused(on(bus, {"replay", "--mission", kPasses / "nominal" / "mission.toml", "--telemetry",
                   kPasses / "nominal"}),
          {"nobody subscribes"}, 1);
}

}  // namespace spindrift::serve_test
