/// @file
/// Measures how fast a running `spindrift serve` commits pulses from the bus as rows.
///
///     bus_load PULSES.csv SPACECRAFT_ID ARCHIVE.db RATE [DOMAIN]
///
/// RATE is in edges/s; 0 sends as fast as the service accepts. Prints the numbers of edges and of
/// rows at the end, and the edges/s from the first write to the commit of the last row.

#include <SQLiteCpp/Database.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "services/bus/participant.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/bench/load_support.h"

namespace spindrift {
namespace {

using bench::or_exit;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPoll{5};
constexpr std::chrono::minutes kPatience{5};
constexpr int kBusy_ms = 30'000;

void publish(TelemetryPublisher<Pulse>& publisher, const std::vector<Pulse>& pulses,
             const std::string& spacecraft, double rate) {
  const auto start = steady_clock::now();
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    const auto due = rate > 0.0
                         ? start + std::chrono::duration_cast<steady_clock::duration>(
                                       std::chrono::duration<double>{static_cast<double>(i) / rate})
                         : start;
    if (due > steady_clock::now()) {
      publisher.flush();
      std::this_thread::sleep_until(due);
    }
    or_exit(publisher.publish(spacecraft, pulses[i], std::stop_token{}));
  }
  or_exit(publisher.wait_for_acknowledgments(kPatience));
}

void run(const std::string& file, const std::string& spacecraft, const std::string& archive,
         double rate, std::uint32_t domain) {
  const std::vector<Pulse> pulses = bench::read_pulses(file);
  const auto participant = or_exit(bus::Participant::create({.domain = domain}));
  auto publisher = or_exit(TelemetryPublisher<Pulse>::create(participant, "load", random_session(),
                                                             bus::Sending::Packed));
  or_exit(publisher.wait_for_subscriber(std::chrono::seconds{30}));

  SQLite::Database database{archive, SQLite::OPEN_READONLY, kBusy_ms};
  const auto stored = [&](const std::string& what) {
    return database
        .execAndGet(
            fmt::format("SELECT {} FROM pulse WHERE spacecraft_id = '{}'", what, spacecraft))
        .getInt64();
  };
  const auto start = steady_clock::now();
  publish(publisher, pulses, spacecraft, rate);
  while (stored("max(t_tai_ns)") < tai_ns(pulses.back().t) &&
         steady_clock::now() - start < kPatience) {
    std::this_thread::sleep_for(kPoll);
  }
  const std::chrono::duration<double> taken = steady_clock::now() - start;
  fmt::print("{} {} {:.0f}\n", pulses.size(), stored("count(*)"),
             static_cast<double>(pulses.size()) / taken.count());
}

}  // namespace
}  // namespace spindrift

int main(int argc, char** argv) {
  const std::span<char*> arguments{argv, static_cast<std::size_t>(argc)};
  if (arguments.size() < 5) {
    fmt::print(stderr, "usage: bus_load PULSES.csv SPACECRAFT_ID ARCHIVE.db RATE [DOMAIN]\n");
    return 2;
  }
  spindrift::run(arguments[1], arguments[2], arguments[3], std::stod(arguments[4]),
                 arguments.size() > 5 ? static_cast<std::uint32_t>(std::stoul(arguments[5])) : 0);
  return 0;
}
