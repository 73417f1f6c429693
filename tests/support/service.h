/// @file
/// Runs `spindrift serve` as a child process for one test, and a front-end that feeds it.

#pragma once

#include <SQLiteCpp/Database.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/processed.h"

namespace spindrift {

/// Part of the message of a service that stopped before it had computed everything.
constexpr const char* kLeftToTheNextStart = "the next start of the service will";

/// Runs a service with an archive and a bus of its own.
class Service {
 public:
  explicit Service(std::string pass, const std::string& partition = "", int largest_file_kib = 0)
      : bus_{bus_of_its_own()}, pass_{std::move(pass)} {
    if (!partition.empty()) {
      bus_.partition = partition;
    }
    start(largest_file_kib);
  }

  void start(int largest_file_kib = 0) {
    log_before_ = log();
    program_.emplace(
        std::vector<std::string>{"serve", "--mission", mission(), "--db", db().string(), "--domain",
                                 std::to_string(bus_.domain), "--partition", bus_.partition,
                                 "--json"},
        largest_file_kib);
    ++starts_;
  }

  int starts() const { return starts_; }
  /// Returns the log of all starts.
  std::string log() const { return log_before_ + (program_ ? program_->log() : ""); }

  Program& program() { return *program_; }
  const bus::BusConfig& bus() const { return bus_; }
  std::filesystem::path db() const { return folder_.path() / "served.db"; }
  std::string mission() const { return (kPasses / pass_ / "mission.toml").string(); }

  bool ready() const { return program_->says("ready"); }

  int replay(const std::string& speed) const {
    Program replay{{"replay", "--mission", mission(), "--telemetry", (kPasses / pass_).string(),
                    "--speed", speed, "--domain", std::to_string(bus_.domain), "--partition",
                    bus_.partition}};
    return replay.exit_status();
  }

  /// Serves the whole pass, sent at once, from start to stop.
  /// @return False if any step failed.
  bool serves_its_pass() { return ready() && replay("0") == 0 && stop_when_computed() == 0; }

  /// Stops the service. A stop computes for a few seconds only, so the service is started again as
  /// long as it leaves work, as happens on a busy machine.
  int stop_when_computed() {
    constexpr int kMostStops = 10;
    int status = stop_when_at_rest();
    for (int stops = 1; status == 0 && stops < kMostStops &&
                        program_->log().find(kLeftToTheNextStart) != std::string::npos;
         ++stops) {
      start();
      status = ready() ? stop_when_at_rest() : -1;
    }
    return status;
  }

  int stop() {
    program_->signal(SIGTERM);
    return program_->exit_status();
  }

 private:
  /// Stops the service once it has committed nothing for a while.
  int stop_when_at_rest() {
    using namespace std::chrono_literals;
    using Clock = std::chrono::steady_clock;
    SQLite::Database archive{db().string()};
    const auto commits = [&] { return archive.execAndGet("PRAGMA data_version").getInt(); };
    int last = commits();
    for (auto since = Clock::now(); Clock::now() - since < 2s; std::this_thread::sleep_for(50ms)) {
      if (const int now = commits(); now != last) {
        last = now;
        since = Clock::now();
      }
    }
    return stop();
  }

  TemporaryFolder folder_;
  bus::BusConfig bus_;
  std::string pass_;
  std::optional<Program> program_;
  std::string log_before_;
  int starts_ = 0;
};

/// Runs `serve` with these arguments and the telemetry from `send`, and restarts it until
/// everything is computed.
template <class Send>
void serve_whole(const std::vector<std::string>& serve, const Send& send) {
  constexpr int kMostStarts = 6;
  for (int starts = 0; starts < kMostStarts; ++starts) {
    Program service{serve};
    ASSERT_TRUE(service.says("ready")) << service.log();
    if (starts == 0) {
      send();
    }
    // A busy machine may not finish within one stop, so each start gets more time.
    std::this_thread::sleep_for(starts * std::chrono::seconds{8});
    service.signal(SIGTERM);
    ASSERT_EQ(service.exit_status(), 0) << service.log();
    if (service.log().find(kLeftToTheNextStart) == std::string::npos) {
      return;
    }
  }
  FAIL() << "not computed by " << kMostStarts << " starts";
}

/// Returns the pulses of a recorded pass, read back from an archive.
inline std::vector<Pulse> pulses_of(const std::string& pass) {
  return pulses_in(Processed{pass}.db);
}

/// Sends the pulses of a recorded pass like a front-end.
class FrontEnd {
 public:
  FrontEnd(const bus::BusConfig& bus, std::string spacecraft, std::vector<Pulse> pulses,
           const std::string& source = "front-end")
      : spacecraft_{std::move(spacecraft)},
        participant_{bus::Participant::create(bus).value()},
        publisher_{TelemetryPublisher<Pulse>::create(participant_, source).value()},
        pulses_{std::move(pulses)} {}

  /// Sends the next pulses up to `share` of all, with a pause before each.
  /// @return False if there is no subscriber.
  bool send_until(double share, std::chrono::microseconds pause = {}) {
    const auto end = static_cast<std::size_t>(share * static_cast<double>(pulses_.size()));
    if (!publisher_.wait_for_subscriber(std::chrono::seconds{30})) {
      return false;
    }
    for (; next_ < end; ++next_) {
      std::this_thread::sleep_for(pause);
      if (!publisher_.publish(spacecraft_, pulses_[next_], std::stop_token{})) {
        return false;
      }
    }
    return publisher_.wait_for_acknowledgments(std::chrono::seconds{30}).has_value();
  }

 private:
  std::string spacecraft_;
  bus::Participant participant_;
  TelemetryPublisher<Pulse> publisher_;
  std::vector<Pulse> pulses_;
  std::size_t next_ = 0;
};

}  // namespace spindrift
