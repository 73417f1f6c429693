// `spindrift serve` fed by `spindrift replay`: real processes, DDS and archive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spindrift.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "services/bus/qos.h"
#include "services/bus/reader.h"
#include "services/publisher/product_messages.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/service.h"

namespace spindrift::serve_test {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Serve, GivesTheRowsOfProcessBitForBit) {
  Service service{"gms5"};
  ASSERT_TRUE(service.serves_its_pass()) << service.program().log();

  const TemporaryFolder folder;
  const auto offline = folder.path() / "processed.db";
  Program process{{"process", "--mission", service.mission(), "--telemetry",
                   (kPasses / "gms5").string(), "--db", offline.string()}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();

  const auto rows = product_rows(offline);
  EXPECT_GT(rows.size(), 15000U);
  EXPECT_EQ(product_rows(service.db()), rows);
  EXPECT_EQ(last_batch_rows(service.db()), last_batch_rows(offline));
  // The number of periodic solutions before the stop depends on the machine; the restart tests
  // check that the next start makes the others.
  EXPECT_EQ(number_of(offline, "SELECT count(*) FROM spin_batch"), 1);
}

// Single edges and bursts are computed on different threads, and processing moves between them.
TEST(Serve, GivesTheRowsOfProcessWhetherEdgesComeOneByOneOrInBursts) {
  const TemporaryFolder folder;
  const auto offline = folder.path() / "processed.db";
  Program process{{"process", "--mission", (kPasses / "gms5" / "mission.toml").string(),
                   "--telemetry", (kPasses / "gms5").string(), "--db", offline.string()}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();

  Service service{"gms5"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  FrontEnd front_end{service.bus(), "GMS-5", pulses_in(offline)};
  constexpr int kParts = 12;
  for (int part = 0; part < kParts; ++part) {
    ASSERT_TRUE(front_end.send_until((part + 0.6) / kParts));
    ASSERT_TRUE(front_end.send_until((part + 1.0) / kParts, 300us));
  }
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();
  EXPECT_EQ(product_rows(service.db()), product_rows(offline));
}

TEST(Serve, CountsWhatEachSourceSent) {
  Service service{"nominal"};
  ASSERT_TRUE(service.serves_its_pass()) << service.program().log();

  EXPECT_EQ(rows_of(service.db(),
                    "SELECT source, received, gaps, duplicates, disordered FROM source_count"),
            std::vector<std::string>{"replay|3600|0|0|0|"});
  const auto report = nlohmann::json::parse(service.program().out());
  EXPECT_EQ(report["runs"][0]["edges_received"], 3600);
}

TEST(Serve, PublishesItsResultsForThoseWhoComeLater) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_EQ(service.replay("0"), 0);
  const auto participant = bus::Participant::create(service.bus()).value();
  const auto estimates = bus::Reader<spindrift_SpinEstimate>::create(
                             participant, product_topic<SpinEstimate>(), bus::results_qos())
                             .value();
  const auto health =
      bus::Reader<spindrift_Health>::create(participant, bus::kHealthTopic, bus::results_qos())
          .value();

  // Keep the latest estimate of each estimator; more of `batch` may follow.
  std::map<std::string, spindrift_SpinEstimate> latest;
  ASSERT_TRUE(eventually([&] {
    estimates
        .take([&](const spindrift_SpinEstimate& estimate) {
          latest.insert_or_assign(estimate.estimator, estimate);
        })
        .value();
    return latest.size() == 3;
  }));
  std::vector<spindrift_Health> beats;
  std::vector<spindrift_SpacecraftHealth> links;
  ASSERT_TRUE(eventually([&] {
    health
        .take([&](const spindrift_Health& beat) {
          beats.push_back(beat);
          links.push_back(beat.spacecraft._buffer[0]);
        })
        .value();
    return !beats.empty() && beats.back().samples_committed == 3600;
  }));
  EXPECT_STREQ(links.back().spacecraft, "SPINNER");
  EXPECT_NE(links.back().link, spindrift_LINK_WAITING);
  EXPECT_EQ(links.back().last_sample_tai_ns,
            number_of(service.db(), "SELECT max(t_tai_ns) FROM pulse"));
  EXPECT_STREQ(beats.back().status, "ok");
  EXPECT_EQ(beats.back().samples_received, 3600U);
  ASSERT_EQ(service.stop(), 0) << service.program().log();

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
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  // At this speed the second edge is due after a minute.
  Program replay{{"replay", "--mission", service.mission(), "--telemetry",
                  (kPasses / "nominal").string(), "--speed", "0.001", "--domain",
                  std::to_string(service.bus().domain), "--partition", service.bus().partition}};
  EXPECT_TRUE(
      eventually([&] { return number_of(service.db(), "SELECT count(*) FROM pulse") == 1; }));
  replay.signal(SIGTERM);
  EXPECT_EQ(replay.exit_status(), 1);
  ASSERT_EQ(service.stop(), 0) << service.program().log();
}

TEST(Serve, StoresAnEdgeOnceHoweverOftenItArrives) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();

  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM pulse_use WHERE rejected_by = 'late'"),
            0);
  EXPECT_EQ(number_of(service.db(), "SELECT max(revolution) FROM revolution"), 599);
}

TEST(Serve, StoresWhatCannotBeTrueWithItsReason) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  const auto participant = bus::Participant::create(service.bus()).value();
  auto front_end = TelemetryPublisher<Pulse>::create(participant, "front-end").value();
  ASSERT_TRUE(front_end.wait_for_subscriber(30s));
  const std::stop_token never;
  const Pulse pulse{.t = tai_from_ns(1795143637568806257), .channel = PulseChannel::Sun1};
  ASSERT_TRUE(
      front_end.publish("SPINNER", {.t = tai_from_ns(-1), .channel = pulse.channel}, never));
  ASSERT_TRUE(front_end.publish("SPINNER", pulse, never));
  ASSERT_TRUE(front_end.wait_for_acknowledgments(30s));
  ASSERT_EQ(service.stop(), 0) << service.program().log();

  const auto rows =
      rows_of(service.db(), "SELECT source, line, reason FROM rejected_input ORDER BY 2");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_THAT(rows[0], HasSubstr("front-end|0|"));
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM pulse"), 1);
}

TEST(Serve, LeavesTheSpacecraftOfOthersAlone) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
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
  ASSERT_EQ(service.stop(), 0) << service.program().log();

  EXPECT_EQ(nlohmann::json::parse(service.program().out())["other_spacecraft"],
            (nlohmann::json{{"OTHER", kPairs}}));
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM pulse"), kPairs);
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM rejected_input"), 0);
  EXPECT_EQ(rows_of(service.db(),
                    "SELECT source, received, gaps, duplicates, disordered FROM source_count"),
            std::vector<std::string>{"front-end|2000|0|0|0|"});
  const std::string log = service.program().log();
  EXPECT_EQ(log.find("'OTHER'"), log.rfind("'OTHER'"));
  EXPECT_THAT(log, HasSubstr("'OTHER'"));
}

TEST(Serve, FinishesItsRunWhenStopped) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  service.program().signal(SIGINT);
  ASSERT_EQ(service.program().exit_status(), 0) << service.program().log();
  EXPECT_EQ(number_of(service.db(),
                      "SELECT count(*) FROM run WHERE mode = 'live' AND finished_utc IS NOT NULL"),
            1);
}

TEST(Serve, SaysAtTheEndOfARunWhichEstimatorsDisagree) {
  const PassCopy pass{"nominal"};
  pass.replace("mount_angle_deg = 85", "mount_angle_deg = 86");
  Service service{pass.folder.path().string()};
  ASSERT_TRUE(service.serves_its_pass()) << service.program().log();
  EXPECT_THAT(service.log(), HasSubstr("SPINNER: sequential and batch disagree"));
  const auto report = nlohmann::json::parse(service.program().out());
  EXPECT_EQ(report["runs"][0]["disagreements"][0]["other"], "batch");
}

TEST(Serve, CallsItsRunAReplayInThatPartition) {
  Service service{"nominal", "replay"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_EQ(service.stop(), 0) << service.program().log();
  EXPECT_EQ(
      rows_of(service.db(), "SELECT mode, telemetry FROM run JOIN run_telemetry USING (run_id)"),
      std::vector<std::string>{"replay|DDS domain " + std::to_string(service.bus().domain) +
                               ", partition replay|"});
}

TEST(Serve, RefusesASecondWriterAndNamesTheHolder) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  Program second{{"process", "--mission", service.mission(), "--telemetry",
                  (kPasses / "nominal").string(), "--db", service.db().string()}};
  EXPECT_EQ(second.exit_status(), 1);
  EXPECT_THAT(second.log(), HasSubstr("pid"));
  ASSERT_EQ(service.stop(), 0) << service.program().log();
}

TEST(Serve, StopsAcceptingLoudlyWhenTheDiskIsFullAndEndsWithOne) {
  Service service{"gms5", "", 600};
  ASSERT_TRUE(service.ready()) << service.program().log();
  Program replay{{"replay", "--mission", service.mission(), "--telemetry",
                  (kPasses / "gms5").string(), "--speed", "0", "--domain",
                  std::to_string(service.bus().domain), "--partition", service.bus().partition}};
  ASSERT_TRUE(service.program().says("the archive does not store")) << service.program().log();
  // A late subscriber learns it from the bus, a reader from the log.
  const auto participant = bus::Participant::create(service.bus()).value();
  const auto health =
      bus::Reader<spindrift_Health>::create(participant, bus::kHealthTopic, bus::results_qos())
          .value();
  // The archive's path alone fills the status, so the reason is in the message.
  EXPECT_TRUE(eventually([&] {
    std::string message;
    health.take([&](const spindrift_Health& beat) { message = beat.message; }).value();
    return message.starts_with("not storing: ") &&
           message.find("(SQLite code ") != std::string::npos;
  }));
  EXPECT_TRUE(service.program().says("the archive still does not store"));
  EXPECT_EQ(service.stop(), 1);
  EXPECT_THAT(service.log(), HasSubstr("rows that were accepted are not in archive"));
  replay.signal(SIGKILL);

  // What is stored is consistent: samples and products of each batch together.
  EXPECT_EQ(rows_of(service.db(), "PRAGMA integrity_check"), std::vector<std::string>{"ok|"});
  EXPECT_EQ(number_of(service.db(),
                      "SELECT count(*) FROM pulse_use LEFT JOIN pulse USING"
                      " (spacecraft_id, t_tai_ns, channel) WHERE pulse.t_tai_ns IS NULL"),
            0);
}

TEST(Serve, NamesAWriterWhoseQosDoesNotDo) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  const ForeignWriter weak{service.bus(), "weak", 1};
  ASSERT_TRUE(service.program().says("BEST_EFFORT")) << service.program().log();
  EXPECT_THAT(service.log(), HasSubstr("pid " + std::to_string(weak.pid())));
  ASSERT_EQ(service.stop(), 0) << service.program().log();
}

TEST(Serve, RefusesTwoMissionsOfOneSpacecraft) {
  const TemporaryFolder folder;
  const std::string mission = (kPasses / "nominal" / "mission.toml").string();
  Program program{
      {"serve", "--mission", mission, mission, "--db", (folder.path() / "out.db").string()}};
  EXPECT_EQ(program.exit_status(), 2);
  EXPECT_THAT(program.log(), HasSubstr("SPINNER"));
}

TEST(Serve, TellsOfAllBadMissionFilesAtOnce) {
  const TemporaryFolder folder;
  const std::string good = (kPasses / "nominal" / "mission.toml").string();
  const auto bad = folder.write("bad.toml", "[spacecraft]\nid = \"BAD\"\n");
  const auto worse = folder.write("worse.toml", "not a mission file");
  Program program{{"serve", "--mission", good, bad.string(), worse.string(), "--db",
                   (folder.path() / "out.db").string()}};
  EXPECT_EQ(program.exit_status(), 2);
  EXPECT_THAT(program.log(), HasSubstr("bad.toml"));
  EXPECT_THAT(program.log(), HasSubstr("worse.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.db"));
}

TEST(Serve, GivesEachOfSeveralMissionsTheRowsOfItsOwnService) {
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  const auto on_bus = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(),
                     {"--domain", std::to_string(bus.domain), "--partition", bus.partition});
    return arguments;
  };
  const std::vector<std::string> passes{"gms5", "nominal"};
  const auto mission = [](const std::string& pass) {
    return (kPasses / pass / "mission.toml").string();
  };
  const auto db = folder.path() / "all.db";
  serve_whole(
      on_bus({"serve", "--mission", mission(passes[0]), mission(passes[1]), "--db", db.string()}),
      [&] {
        for (const std::string& pass : passes) {
          Program replay{on_bus({"replay", "--mission", mission(pass), "--telemetry",
                                 (kPasses / pass).string(), "--speed", "0"})};
          ASSERT_EQ(replay.exit_status(), 0) << replay.log();
        }
      });

  for (const std::string& pass : passes) {
    const auto alone = folder.path() / (pass + ".db");
    Program process{{"process", "--mission", mission(pass), "--telemetry",
                     (kPasses / pass).string(), "--db", alone.string()}};
    ASSERT_EQ(process.exit_status(), 0) << process.log();
    const std::string spacecraft = rows_of(alone, "SELECT spacecraft_id FROM run").at(0);
    const std::string query =
        "SELECT t_tai_ns, ra_deg, dec_deg, sigma_deg, spin_rate_rpm FROM spin_estimate"
        " JOIN run USING (run_id) WHERE spacecraft_id = '" +
        spacecraft.substr(0, spacecraft.size() - 1) +
        "' AND estimator <> 'batch' ORDER BY 1, estimator";
    EXPECT_GT(rows_of(alone, query).size(), 500U);
    EXPECT_EQ(rows_of(db, query), rows_of(alone, query));
  }
}

TEST(Serve, CountsASourceOnceForAllItsMissions) {
  const TemporaryFolder folder;
  std::string other = text_of(kPasses / "nominal" / "mission.toml");
  other.replace(other.find("SPINNER"), 7, "SECOND");
  folder.write("mission.toml", other);
  std::filesystem::copy(kPasses / "nominal" / "orbit.oem", folder.path() / "orbit.oem");
  const std::string first = (kPasses / "nominal" / "mission.toml").string();
  const std::string second = (folder.path() / "mission.toml").string();
  const std::filesystem::path db = folder.path() / "out.db";
  const bus::BusConfig bus = bus_of_its_own();
  const std::vector<std::string> on_bus{"--domain", std::to_string(bus.domain), "--partition",
                                        bus.partition};
  std::vector<std::string> serve{"serve", "--mission", first, second, "--db", db.string()};
  serve.insert(serve.end(), on_bus.begin(), on_bus.end());
  Program service{serve};
  ASSERT_TRUE(service.says("ready")) << service.log();
  for (const std::string& mission : {first, second}) {
    std::vector<std::string> replay{
        "replay",  "--mission", mission, "--telemetry", (kPasses / "nominal").string(),
        "--speed", "0"};
    replay.insert(replay.end(), on_bus.begin(), on_bus.end());
    ASSERT_EQ(Program{replay}.exit_status(), 0);
  }
  service.signal(SIGTERM);
  ASSERT_EQ(service.exit_status(), 0) << service.log();

  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse"), 7200);
  EXPECT_EQ(rows_of(db,
                    "SELECT spacecraft_id, source, received, gaps, disordered"
                    " FROM source_count JOIN run USING (run_id)"),
            std::vector<std::string>{"SPINNER|replay|7200|0|0|"});
}

TEST(Replay, GivesUpWhenNobodySubscribes) {
  const bus::BusConfig bus = bus_of_its_own();
  Program program{{"replay", "--mission", (kPasses / "nominal" / "mission.toml").string(),
                   "--telemetry", (kPasses / "nominal").string(), "--domain",
                   std::to_string(bus.domain), "--partition", bus.partition}};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("nobody subscribes"));
}

}  // namespace spindrift::serve_test
