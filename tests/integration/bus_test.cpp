#include <arpa/inet.h>
#include <dds/dds.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <vector>

#include "services/bus/cyclone_log.h"
#include "services/bus/network.h"
#include "services/bus/wait_set.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::bus_test {

using namespace std::chrono_literals;
using bus::Participant;
using bus::Reader;

/// Sets CYCLONEDDS_URI during its lifetime.
class NetworkOverride {
 public:
  explicit NetworkOverride(const std::string& uri) {
    if (const char* before = std::getenv("CYCLONEDDS_URI"); before != nullptr) {
      before_ = before;
    }
    setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  }
  ~NetworkOverride() {
    if (before_) {
      setenv("CYCLONEDDS_URI", before_->c_str(), 1);
    } else {
      unsetenv("CYCLONEDDS_URI");
    }
  }
  NetworkOverride(const NetworkOverride&) = delete;
  NetworkOverride& operator=(const NetworkOverride&) = delete;

 private:
  std::optional<std::string> before_;
};

class OnBus : public ::testing::Test {
 protected:
  /// Returns a participant in another partition.
  Participant stranger() const {
    return Participant::create(
               {.domain = config_.domain, .partition = config_.partition + "-other"})
        .value();
  }

  bus::BusConfig config_ = bus_of_its_own();
  Participant participant_ = Participant::create(config_).value();
};
using ReaderTest = OnBus;
using WriterTest = OnBus;
using WaitSetTest = OnBus;

/// Holds the ports of a domain's first participants, as if so many programs were there.
class TakenIndices {
 public:
  TakenIndices(std::uint32_t domain, int count) {
    constexpr std::uint32_t kFirstPort = 7410;
    for (std::uint32_t port = kFirstPort + 250 * domain; std::ssize(sockets_) < count; port += 2) {
      const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(static_cast<std::uint16_t>(port));
      EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
      sockets_.push_back(socket);
    }
  }
  ~TakenIndices() {
    for (const int socket : sockets_) {
      ::close(socket);
    }
  }
  TakenIndices(const TakenIndices&) = delete;
  TakenIndices& operator=(const TakenIndices&) = delete;

 private:
  std::vector<int> sockets_;
};

TEST(Network, HasAnIndexLeftBesideAHundredOtherPrograms) {
  const bus::BusConfig config = bus_of_its_own();
  const TakenIndices taken{config.domain, 100};
  EXPECT_TRUE(Participant::create(config));
}

TEST(Network, SaysWhatToDoWhereADomainHasNoIndexLeft) {
  const bus::BusConfig config = bus_of_its_own();
  const TakenIndices taken{config.domain, 120};
  EXPECT_THAT(Participant::create(config),
              IsRefused(ErrorCode::Unavailable, HasSubstr("end some of them, or use another")));
}

TEST(Network, IsThisHostOnlyUnlessToldOtherwise) {
  const NetworkOverride none{""};
  const auto network = bus::network_configuration();
  EXPECT_THAT(network.name, HasSubstr("loopback.xml"));
  EXPECT_THAT(network.text, AllOf(HasSubstr("<NetworkInterface name=\"lo\"/>"),
                                  HasSubstr("<AllowMulticast>false</AllowMulticast>"),
                                  HasSubstr("<Peer Address=\"localhost\"/>")));
}

TEST(Network, IsThatOfTheEnvironmentWhenSet) {
  const NetworkOverride file{"file:///etc/ship.xml"};
  EXPECT_EQ(bus::network_configuration().text, "file:///etc/ship.xml");
  EXPECT_EQ(bus::network_configuration().name, "CYCLONEDDS_URI=file:///etc/ship.xml");
}

TEST(Participant, TellsDomainPartitionAndNetworkInForce) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  EXPECT_THAT(participant.description(), AllOf(HasSubstr("domain "), HasSubstr("partition 'test-"),
                                               HasSubstr(bus::network_configuration().name)));
}

TEST(Participant, RefusesADomainWhosePortsDoNotExist) {
  EXPECT_THAT(Participant::create({.domain = 231}),
              IsRefused(ErrorCode::InvalidConfiguration, "DDS domain 231: must be 0 to 230"));
}

TEST(Participant, NamesTheCauseWhenTheNetworkIsRefused) {
  const NetworkOverride unknown{
      "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"nosuch0\"/>"
      "</Interfaces></General></Domain></CycloneDDS>"};
  EXPECT_THAT(Participant::create(bus_of_its_own()),
              IsRefused(ErrorCode::Unavailable,
                        AllOf(HasSubstr("CYCLONEDDS_URI"), HasSubstr("nosuch0: does not match"))));
}

TEST(Participant, SharesItsDomainWithOthersOfTheProcess) {
  const auto config = bus_of_its_own();
  std::optional<Participant> first = Participant::create(config).value();
  const auto second = Participant::create(config).value();
  first.reset();
  const auto third = Participant::create(config).value();
  const auto reader = telemetry_reader<Pulse>(second);
  const auto writer = telemetry_writer<Pulse>(third);
  ASSERT_TRUE(writer.wait_for_reader(30s));
  ASSERT_TRUE(writer.write(idl_pulse(7)));
  EXPECT_THAT(seqs_of(take_samples(reader, 1)), ElementsAre(7));
}

TEST_F(ReaderTest, GivesEveryFieldThatWasWritten) {
  const auto reader = telemetry_reader<Pulse>(participant_);
  const auto writer = telemetry_writer<Pulse>(participant_);
  const spindrift_Pulse sent{.spacecraft = "a spacecraft of 32 characters ..",
                             .source = "and its source, of as many, too.",
                             .session = 0xFEDC'BA98'7654'3210,
                             .seq = 0x0123'4567'89AB'CDEF,
                             .t_tai_ns = -5,
                             .channel = spindrift_SOUTH_OUT};
  ASSERT_TRUE(writer.write(sent));
  const auto taken = take_samples(reader, 1);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_STREQ(taken[0].spacecraft, sent.spacecraft);
  EXPECT_STREQ(taken[0].source, sent.source);
  EXPECT_EQ(taken[0].session, sent.session);
  EXPECT_EQ(taken[0].seq, sent.seq);
  EXPECT_EQ(taken[0].t_tai_ns, sent.t_tai_ns);
  EXPECT_EQ(taken[0].channel, sent.channel);
}

TEST_F(ReaderTest, ThatJoinsLateReceivesTheHistoryOfTelemetry) {
  const auto writer = telemetry_writer<Pulse>(participant_);
  ASSERT_TRUE(write_pulses(writer, 1000));
  EXPECT_EQ(seqs_of(take_samples(telemetry_reader<Pulse>(participant_), 1000)), first_seqs(1000));
}

TEST_F(ReaderTest, ThatJoinsLateReceivesTheLastResultOnly) {
  const auto writer = telemetry_writer<Pulse>(participant_, bus::results_qos());
  ASSERT_TRUE(write_pulses(writer, 10));
  const auto reader = telemetry_reader<Pulse>(participant_, bus::results_qos());
  EXPECT_THAT(seqs_of(take_samples(reader, 1)), ElementsAre(9));
}

TEST_F(ReaderTest, DoesNotHearAnotherPartition) {
  const auto theirs = stranger();
  const auto reader = telemetry_reader<Pulse>(participant_);
  const auto stranger = telemetry_writer<Pulse>(theirs);
  const auto writer = telemetry_writer<Pulse>(participant_);
  ASSERT_TRUE(stranger.write(idl_pulse(1)));
  ASSERT_TRUE(writer.write(idl_pulse(2)));
  EXPECT_THAT(seqs_of(take_samples(reader, 1)), ElementsAre(2));
  EXPECT_EQ(reader.status().value().writers, 1U);
}

TEST_F(ReaderTest, TakesTheEndOfASourceForNoSample) {
  const auto reader = telemetry_reader<Pulse>(participant_);
  bus::Qos disposing = bus::telemetry_writer_qos();
  dds_qset_writer_data_lifecycle(disposing.get(), true);
  {
    const auto writer = telemetry_writer<Pulse>(participant_, disposing);
    ASSERT_TRUE(writer.write(idl_pulse(0)));
    EXPECT_THAT(seqs_of(take_samples(reader, 1)), ElementsAre(0));
  }
  std::size_t samples = 0;
  ASSERT_TRUE(eventually(
      [&] { return reader.take([&samples](const spindrift_Pulse&) { ++samples; }).value() > 0; }));
  EXPECT_EQ(samples, 0U);
}

TEST_F(ReaderTest, NamesAnIncompatibleWriterOfAnotherProcess) {
  const auto reader = telemetry_reader<Pulse>(participant_);
  ForeignWriter writer{config_, "weak", 0};
  ASSERT_TRUE(eventually([&] { return !reader.status().value().incompatible_writers.empty(); }));
  const auto status = reader.status().value();
  EXPECT_EQ(status.writers, 0U);
  EXPECT_THAT(status.incompatible_writers,
              ElementsAre(AllOf(
                  HasSubstr("writer of process "), HasSubstr("bus_foreign_writer"),
                  HasSubstr(" (pid " + std::to_string(writer.pid()) + ") on host "),
                  EndsWith(", topic spindrift/pulse, offers BEST_EFFORT, VOLATILE; spindrift needs "
                           "RELIABLE, TRANSIENT_LOCAL"))));
}

TEST_F(ReaderTest, ForgetsAnIncompatibleWriterThatLeft) {
  const auto reader = telemetry_reader<Pulse>(participant_);
  bus::Qos exclusive = bus::telemetry_writer_qos();
  dds_qset_ownership(exclusive.get(), DDS_OWNERSHIP_EXCLUSIVE);
  {
    const auto writer = telemetry_writer<Pulse>(participant_, exclusive);
    EXPECT_THAT(reader.status().value().incompatible_writers,
                ElementsAre(EndsWith("offers EXCLUSIVE; spindrift needs SHARED")));
  }
  EXPECT_TRUE(eventually([&] { return reader.status().value().incompatible_writers.empty(); }));
}

TEST_F(ReaderTest, DoesNotMindAnIncompatibleWriterOfAnotherPartition) {
  const auto theirs = stranger();
  const auto reader = telemetry_reader<Pulse>(participant_);
  const bus::Qos weak{dds_create_qos()};
  const auto near = telemetry_writer<Pulse>(participant_, weak);
  const auto far = telemetry_writer<Pulse>(theirs, weak);
  EXPECT_THAT(reader.status().value().incompatible_writers, SizeIs(1));
}

TEST_F(WriterTest, NamesAnIncompatibleReader) {
  const auto writer = telemetry_writer<Pulse>(participant_, bus::results_qos());
  bus::Qos demanding = bus::results_qos();
  dds_qset_deadline(demanding.get(), DDS_MSECS(500));
  const auto reader = telemetry_reader<Pulse>(participant_, demanding);
  const auto status = writer.status().value();
  EXPECT_EQ(status.readers, 0U);
  EXPECT_THAT(
      status.incompatible_readers,
      ElementsAre(AllOf(HasSubstr("(pid " + std::to_string(getpid()) + ")"),
                        EndsWith("asks for deadline 0.5 s; spindrift offers no deadline"))));
}

TEST_F(WriterTest, WaitsForAReaderOnlySoLong) {
  const auto writer = telemetry_writer<Pulse>(participant_);
  EXPECT_THAT(
      writer.wait_for_reader(20ms),
      IsRefused(ErrorCode::Unavailable, HasSubstr("waiting for a reader of spindrift/pulse")));
}

TEST_F(WriterTest, GivesUpOnAFullReaderWhenStopped) {
  const auto reader = telemetry_reader<Pulse>(participant_, bus::telemetry_reader_qos(1));
  const auto writer = telemetry_writer<Pulse>(participant_);
  ASSERT_TRUE(writer.write(idl_pulse(0)));
  std::stop_source stop;
  const std::jthread stopper{[&stop] {
    std::this_thread::sleep_for(50ms);
    stop.request_stop();
  }};
  EXPECT_THAT(writer.write(idl_pulse(1), stop.get_token()),
              IsRefused(ErrorCode::Unavailable, HasSubstr("writing to spindrift/pulse")));
}

TEST_F(WriterTest, OfAnotherProcessWaitsForASlowReaderAndLosesNothing) {
  constexpr std::size_t kCount = 20'000;
  const auto reader = telemetry_reader<Pulse>(participant_, bus::telemetry_reader_qos(500));
  ForeignWriter writer{config_, "telemetry", kCount};
  // The reader must be full before the first sample is taken.
  ASSERT_TRUE(eventually([&] { return reader.status().value().rejected > 0; }));
  EXPECT_EQ(seqs_of(take_samples(reader, kCount)), first_seqs(kCount));
  EXPECT_EQ(writer.exit_status(), 0);
}

TEST_F(WaitSetTest, WakesForDataAndForStop) {
  const auto reader = telemetry_reader<Pulse>(participant_);
  const auto writer = telemetry_writer<Pulse>(participant_);
  auto waitset = bus::WaitSet::create(participant_).value();
  ASSERT_TRUE(waitset.attach(reader.data()));
  ASSERT_TRUE(writer.write(idl_pulse(0)));
  EXPECT_TRUE(waitset.wait().value());
  EXPECT_EQ(take_samples(reader, 1).size(), 1U);
  std::thread stopper{[&waitset] { waitset.stop(); }};
  EXPECT_FALSE(waitset.wait().value());
  stopper.join();
  EXPECT_FALSE(waitset.wait().value());
}

TEST(LogLimit, SaysWhatAPlaceRepeatsOnceAMinute) {
  bus::LogLimit limit;
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(limit.pass("a.c", 1, now), 0U);
  EXPECT_EQ(limit.pass("a.c", 2, now), 0U);
  EXPECT_EQ(limit.pass("b.c", 1, now), 0U);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(limit.pass("a.c", 1, now + 59s), std::nullopt);
  }
  EXPECT_EQ(limit.pass("a.c", 1, now + 60s), 1000U);
  EXPECT_EQ(limit.pass("a.c", 1, now + 61s), std::nullopt);
}

TEST_F(ReaderTest, HandsOverNothingThatItsFilterRefuses) {
  std::atomic<int> asked = 0;
  const auto reader = Reader<spindrift_Pulse>::create(participant_, bus::topic_of<Pulse>(),
                                                      bus::telemetry_reader_qos(),
                                                      [&asked](const spindrift_Pulse& pulse) {
                                                        ++asked;
                                                        return pulse.seq % 2 == 0;
                                                      })
                          .value();
  ASSERT_TRUE(write_pulses(telemetry_writer<Pulse>(participant_), 10));
  EXPECT_THAT(seqs_of(take_samples(reader, 5)), ElementsAre(0, 2, 4, 6, 8));
  EXPECT_EQ(asked, 10);
}

}  // namespace spindrift::bus_test
