// A service that is killed in the middle of a pass and started again at once: its archive is that
// of a service that was never killed, at several speeds.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"
#include "tests/support/simulated.h"

namespace spindrift::restart_at_speed_test {

struct Speed {
  double times;          ///< Speed of the replay as a multiple of real time.
  std::string length_s;  ///< Length of the pass: the kill and the lease of 10 s are within it.
  friend void PrintTo(const Speed& speed, std::ostream* out) { *out << speed.times; }
};

/// Runs services of a simulated pass, and gives all rows of their archives.
class RestartAtSpeed : public ::testing::TestWithParam<Speed> {
 protected:
  struct Running {
    const Simulated& pass;
    const bus::BusConfig& bus;
    std::filesystem::path db;

    Words serve() const { return on(bus, {"serve", "--mission", pass.mission(), "--db", db}); }
    std::int64_t samples(const std::string& table) const { return count_rows(db, table); }
  };

  /// @param table Table of the samples by which the kill is timed.
  /// @param kill_at Number of samples after which the service is killed; 0: it is not.
  /// @param send Sends the whole pass to a service; called on a thread of its own.
  template <class Send>
  static std::vector<std::string> rows(const Simulated& pass, const std::string& table,
                                       std::int64_t kill_at, const Send& send) {
    const TemporaryFolder folder;
    const bus::BusConfig bus = bus_of_its_own();
    const Running running{.pass = pass, .bus = bus, .db = folder.path() / "served.db"};
    auto service = std::make_unique<Serving>(running.serve());
    std::thread sender{[&] { send(running); }};
    if (kill_at > 0) {
      EXPECT_TRUE(eventually([&] { return running.samples(table) >= kill_at; }));
      service->signal(SIGKILL);
      EXPECT_EQ(service->exit_status(), -1);
      service = std::make_unique<Serving>(running.serve());
    }
    sender.join();
    EXPECT_TRUE(eventually([&] { return running.samples("stream_silence") > 0; }));
    stop_in_order(*service);
    EXPECT_EQ(running.samples("stream_silence"), 1) << service->log();
    EXPECT_EQ(running.samples("alert WHERE key = 'link.silent' AND state <> 'active'"), 0);
    std::vector<std::string> all = all_rows(running.db);
    // It has the time of the host.
    std::erase_if(all, [](const std::string& row) {
      return row.starts_with("notice||source_apart_from_host");
    });
    return all;
  }

  static void expect_the_same(const std::vector<std::string>& rows,
                              const std::vector<std::string>& whole) {
    std::vector<std::string> differing;
    std::set_symmetric_difference(rows.begin(), rows.end(), whole.begin(), whole.end(),
                                  std::back_inserter(differing));
    EXPECT_THAT(differing, ::testing::IsEmpty());
  }
};

/// Returns the pulses with every 97th sent 50 later, some of them too late, and every 61st sent
/// twice.
std::vector<Pulse> dirty_pulses(const Simulated& pass) {
  std::vector<Pulse> pulses = pulses_in(Processed{pass.pass}.db);
  for (std::size_t i = 0; i + 50 < pulses.size(); i += 97) {
    const auto first = pulses.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(first, first + 1, first + 50);
  }
  std::vector<Pulse> all;
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    all.push_back(pulses[i]);
    if (i % 61 == 60) {
      all.push_back(pulses[i - 20]);
    }
  }
  return all;
}

TEST_P(RestartAtSpeed, OfASpinnerWithDirtyShuffledAndRepeatedEdgesChangesNoRow) {
  const Simulated pass{"gto-dirty.toml",
                       {{"duration_s = 600.0", "duration_s = " + GetParam().length_s},
                        {"[[faults.silence]]\nfrom_s = 200.0\nto_s = 260.0\n", ""}}};
  const std::vector<Pulse> pulses = dirty_pulses(pass);
  const std::chrono::duration<double> pause{std::stod(GetParam().length_s) / GetParam().times /
                                            static_cast<double>(pulses.size())};
  const auto send = [&](const Running& running) {
    EXPECT_TRUE((FrontEnd{running.bus, "SPINNER", pulses}.send_until(
        1.0, std::chrono::duration_cast<std::chrono::microseconds>(pause))));
  };
  const auto whole = rows(pass, "pulse", 0, send);
  for (const std::int64_t share : {3, 5}) {
    expect_the_same(rows(pass, "pulse", std::ssize(pulses) * share / 10, send), whole);
  }
}

TEST_P(RestartAtSpeed, OfAThreeAxisSpacecraftChangesNoRow) {
  const Simulated pass{"tumbling.toml",
                       {{"duration_s = 1800.0", "duration_s = " + GetParam().length_s},
                        {"first_star_fix_s = 1200.0", "first_star_fix_s = 10.0"}}};
  const auto send = [&](const Running& running) {
    Program replay{
        on(running.bus, {"replay", "--mission", running.pass.mission(), "--telemetry",
                         running.pass.pass, "--speed", std::to_string(GetParam().times)})};
    EXPECT_EQ(replay.exit_status(), 0) << replay.log();
  };
  const auto whole = rows(pass, "gyro_sample", 0, send);
  const std::int64_t gyro_samples =
      std::count_if(whole.begin(), whole.end(),
                    [](const std::string& row) { return row.starts_with("gyro_sample|"); });
  for (const std::int64_t share : {3, 5}) {
    expect_the_same(rows(pass, "gyro_sample", gyro_samples * share / 10, send), whole);
  }
}

INSTANTIATE_TEST_SUITE_P(At, RestartAtSpeed,
                         ::testing::Values(Speed{1.0, "40.0"}, Speed{12.0, "400.0"},
                                           Speed{60.0, "1000.0"}),
                         [](const auto& speed) {
                           return std::to_string(static_cast<int>(speed.param.times));
                         });

}  // namespace spindrift::restart_at_speed_test
