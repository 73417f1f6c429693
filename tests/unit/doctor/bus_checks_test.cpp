#include "services/doctor/network.h"
#include "services/doctor/presence.h"
#include "services/doctor/report.h"
#include "tests/support/doctor_checks.h"
#include "tests/support/matchers.h"

namespace spindrift::doctor::bus_checks_test {

using enum Verdict;

// --- network

// Trace as written by Cyclone DDS 0.10.2, shortened.
constexpr std::string_view kTrace =
    "config: Domain/General/AllowMulticast/#text: false {1}\n"
    "config: Domain/Discovery/Peers/Peer[@Address]: localhost {1}\n"
    "config: Domain/Discovery/Peers/Peer[@Address]: 10.0.0.7 {1}\n"
    "config: Domain/Discovery/ParticipantIndex/#text: auto {1}\n"
    "config: Domain/Discovery/MaxAutoParticipantIndex/#text: 4 {}\n"
    "config: Domain/Discovery/ExternalDomainId/#text: 77 {}\n"
    "config: Domain/Discovery/Ports/Base/#text: 7400 {}\n"
    "config: Domain/Discovery/Ports/DomainGain/#text: 250 {}\n"
    "config: Domain/Discovery/Ports/UnicastMetaOffset/#text: 10 {}\n"
    "config: Domain/Discovery/Ports/ParticipantGain/#text: 2 {}\n"
    "interfaces: lo udp/127.0.0.1(q1) eth0 udp/192.0.2.2(q9)\n"
    "selected interfaces: lo (index 1 priority 2), eth0 (index 2 priority 0)\n"
    "socket receive buffer size set to 425984 bytes\n"
    "rtps_init: domainid 77 participantid 1\n";

TEST(DoctorNetwork, ReadsWhatCycloneMadeOfItsConfiguration) {
  const NetworkSettings settings = settings_of(kTrace);
  EXPECT_EQ(settings.interfaces, "lo, eth0");
  EXPECT_EQ(settings.multicast, "false");
  EXPECT_EQ(settings.peers, (std::vector<std::string>{"localhost", "10.0.0.7"}));
  EXPECT_EQ(settings.indices, 4);
  EXPECT_EQ(settings.first_port, 26660);
  EXPECT_EQ(settings.receive_buffer_bytes, 425984);
}

TEST(DoctorNetwork, CountsNoIndicesWhereParticipantsAreNotNumbered) {
  EXPECT_EQ(settings_of("config: Domain/Discovery/ParticipantIndex/#text: none {}\n").indices,
            std::nullopt);
  EXPECT_EQ(settings_of("").indices, std::nullopt);
}

TEST(DoctorNetwork, CountsAnIndexAsTakenWhenEitherOfItsPortsIs) {
  const NetworkSettings settings = settings_of(kTrace);
  const std::string head = "   sl  local_address rem_address   st\n";
  EXPECT_EQ(free_indices(settings, head), 4);
  // 26660 = 0x6824 is the discovery port of index 0, 26663 = 0x6827 the data port of index 1.
  EXPECT_EQ(free_indices(settings, head + "  12: 0100007F:6824 00000000:0000 07\n"
                                          "  13: 0100007F:6827 00000000:0000 07\n"
                                          "  14: 0100007F:6823 00000000:0000 07\n"),
            2);
}

NetworkFacts good_network() {
  return {.domain = 0,
          .configuration = "built-in loopback.xml",
          .settings = NetworkSettings{.interfaces = "lo",
                                      .multicast = "false",
                                      .peers = {"localhost"},
                                      .indices = 100,
                                      .receive_buffer_bytes = 2097152},
          .free_indices = 99};
}

TEST(DoctorNetwork, JudgesWhoCanBeFoundHowManyFitAndTheReceiveBuffer) {
  EXPECT_THAT(named(check_network(good_network()), "network").found, HasSubstr("interfaces: lo"));
  expect_judged<NetworkFacts>(
      good_network(), check_network,
      {{"refused by Cyclone",
        [](auto& f) {
          f.settings = Unexpected{{ErrorCode::Unavailable, "unknown interface eth7"}};
        },
        "network", Failure, "unknown interface eth7"},
       {"nobody can be found", [](auto& f) { f.settings->peers.clear(); }, "network", Warning},
       {"multicast finds all",
        [](auto& f) {
          f.settings->peers.clear();
          f.settings->multicast = "true";
        },
        "network", Ok},
       {"four more fit", [](auto& f) { f.free_indices = 4; }, "participants", Ok},
       {"three more fit", [](auto& f) { f.free_indices = 3; }, "participants", Warning, "3 of 100"},
       {"least buffer", [](auto& f) { f.settings->receive_buffer_bytes = 1048576; },
        "receive buffer", Ok},
       {"small buffer", [](auto& f) { f.settings->receive_buffer_bytes = 1048575; },
        "receive buffer", Warning}});
}

TEST(DoctorNetwork, FailsWhenNoSampleComesThrough) {
  EXPECT_EQ(check_round_trip(30.0).verdict, Verdict::Ok);
  EXPECT_EQ(check_round_trip(3000.0).verdict, Verdict::Warning);
  EXPECT_EQ(check_round_trip(Unexpected{{ErrorCode::Unavailable, "no sample"}}).verdict,
            Verdict::Failure);
}

// --- presence

Endpoint pulses_in(const std::string& partition) {
  return {.writes = true,
          .topic = "spindrift/pulse",
          .partitions = {partition},
          .owner = "frontend (pid 7) on ant",
          .shortfalls = {}};
}

PresenceFacts present(std::vector<Endpoint> endpoints) {
  return {.bus = {.domain = 3, .partition = "live"},
          .participants = {"frontend (pid 7) on ant"},
          .endpoints = std::move(endpoints)};
}

TEST(DoctorPresence, JudgesWhoPublishesTelemetryWhere) {
  expect_judged<Endpoint>(
      pulses_in("live"), [](const Endpoint& one) { return check_presence(present({one})); },
      {{"pulses", [](auto& /*one*/) {}, "telemetry", Ok, "frontend (pid 7) on ant"},
       {"coded frames", [](auto& one) { one.topic = "spindrift/coded_frame"; }, "telemetry", Ok},
       {"a pattern", [](auto& one) { one.partitions = {"li*"}; }, "telemetry", Ok},
       {"a reader", [](auto& one) { one.writes = false; }, "telemetry", Warning},
       {"no telemetry", [](auto& one) { one.topic = "spindrift/health"; }, "telemetry", Warning},
       {"another partition", [](auto& one) { one.partitions = {"rehearsal"}; }, "telemetry",
        Warning, "'rehearsal'"}});
  EXPECT_THAT(named(check_presence(present({pulses_in("rehearsal")})), "telemetry").advice,
              HasSubstr("--partition"));
  const auto nobody = check_presence(present({}));
  EXPECT_EQ(named(nobody, "telemetry").verdict, Warning);
  expect_advice(nobody);
}

TEST(DoctorPresence, FailsOnAMismatchOfThisPartitionAndNamesIt) {
  Endpoint weak = pulses_in("live");
  weak.shortfalls = {{.offered = "BEST_EFFORT", .needed = "RELIABLE"},
                     {.offered = "VOLATILE", .needed = "TRANSIENT_LOCAL"}};
  const Check qos = named(check_presence(present({weak})), "QoS");
  EXPECT_EQ(qos.verdict, Verdict::Failure);
  EXPECT_THAT(qos.found, HasSubstr("frontend (pid 7) on ant"));
  EXPECT_THAT(qos.found, HasSubstr("offers BEST_EFFORT, VOLATILE, spindrift needs RELIABLE"));

  weak.partitions = {"rehearsal"};
  EXPECT_EQ(named(check_presence(present({weak})), "QoS").verdict, Verdict::Ok);

  Endpoint demanding = pulses_in("live");
  demanding.writes = false;
  demanding.shortfalls = {{.offered = "no deadline", .needed = "deadline 1 s"}};
  EXPECT_THAT(named(check_presence(present({demanding})), "QoS").found,
              HasSubstr("asks for deadline 1 s, spindrift offers no deadline"));
}

TEST(Presence, IsShownWithTheNamesOfOthersEscaped) {
  Endpoint endpoint = pulses_in("live\x1b[2J");
  endpoint.topic = "spindrift/\x07";
  const std::string found = check_presence(present({endpoint})).front().found;
  EXPECT_THAT(found, HasSubstr("spindrift/\\x07 written"));
  EXPECT_THAT(found, HasSubstr("partition 'live\\x1b[2J'"));
}

}  // namespace spindrift::doctor::bus_checks_test
