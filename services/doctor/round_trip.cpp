#include <fmt/format.h>
#include <spindrift.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "services/bus/reader.h"
#include "services/bus/telemetry_messages.h"
#include "services/bus/writer.h"
#include "services/doctor/network.h"

namespace spindrift::doctor {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 5s;
constexpr auto kPoll = 1ms;
// Limit on the partner's lifetime. It ends by itself, so that nobody waits for its lease to expire.
constexpr int kPartnerLimit_s = 10;

Expected<void> send_one(const bus::BusConfig& config) {
  const auto participant = bus::Participant::create(config);
  if (!participant) {
    return Unexpected{participant.error()};
  }
  const auto writer = bus::Writer<spindrift_Pulse>::create(*participant, bus::topic_of<Pulse>(),
                                                           bus::telemetry_writer_qos());
  if (!writer) {
    return Unexpected{writer.error()};
  }
  const spindrift_Pulse pulse{.spacecraft = "DOCTOR",
                              .source = "doctor",
                              .session = 0,
                              .seq = 0,
                              .t_tai_ns = 0,
                              .channel = spindrift_SUN1};
  return writer->wait_for_reader(kPatience).and_then([&] { return writer->write(pulse); });
}

/// Waits until the sample of the other process has arrived.
Expected<void> receive_one(const bus::BusConfig& config,
                           std::chrono::steady_clock::time_point deadline) {
  const auto participant = bus::Participant::create(config);
  if (!participant) {
    return Unexpected{participant.error()};
  }
  const auto reader = bus::Reader<spindrift_Pulse>::create(*participant, bus::topic_of<Pulse>(),
                                                           bus::telemetry_reader_qos());
  if (!reader) {
    return Unexpected{reader.error()};
  }
  while (std::chrono::steady_clock::now() < deadline) {
    const auto taken = reader->take([](const spindrift_Pulse&) {});
    if (!taken) {
      return Unexpected{taken.error()};
    }
    if (*taken > 0) {
      return {};
    }
    std::this_thread::sleep_for(kPoll);
  }
  return Unexpected{{ErrorCode::Unavailable,
                     fmt::format("no sample came from another process of this host within {} s",
                                 std::chrono::seconds{kPatience}.count())}};
}

}  // namespace

RoundTrip round_trip(std::uint32_t domain) {
  const bus::BusConfig config{.domain = domain,
                              .partition = fmt::format("spindrift-doctor-{}", getpid())};
  const pid_t partner = fork();
  if (partner == 0) {
    alarm(kPartnerLimit_s);
    _exit(send_one(config) ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  if (partner < 0) {
    return {.duration_ms = Unexpected{{ErrorCode::Unavailable, "no second process can be started"}},
            .partner = partner};
  }
  const auto start = std::chrono::steady_clock::now();
  const auto received = receive_one(config, start + kPatience);
  const std::chrono::duration<double, std::milli> duration =
      std::chrono::steady_clock::now() - start;
  if (!received) {
    kill(partner, SIGKILL);
  }
  waitpid(partner, nullptr, 0);
  return {.duration_ms = received.map([&] { return duration.count(); }), .partner = partner};
}

}  // namespace spindrift::doctor
