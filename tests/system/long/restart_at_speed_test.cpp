// A service that is killed in the middle of a pass and started again at once: its archive is that
// of a service that was never killed, at several speeds.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/any_front_end.h"
#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"
#include "tests/support/simulated.h"

namespace spindrift::restart_at_speed_test {

constexpr int kKills = 2;

struct Speed {
  double times;          ///< Speed of the sender as a multiple of real time.
  std::string length_s;  ///< Length of the pass: the kill and the lease of 10 s are within it.
  friend void PrintTo(const Speed& speed, std::ostream* out) { *out << speed.times; }
};

/// Returns the samples with every 97th sent 50 later, some of them too late, and every 61st sent
/// twice.
std::vector<AnySample> dirty(std::vector<AnySample> samples) {
  for (std::size_t i = 0; i + 50 < samples.size(); i += 97) {
    const auto first = samples.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(first, first + 1, first + 50);
  }
  std::vector<AnySample> all;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    all.push_back(samples[i]);
    if (i % 61 == 60) {
      all.push_back(samples[i - 20]);
    }
  }
  return all;
}

/// A pass that is sent at a constant pace, and the kind of its samples by which kills are timed.
struct Sent {
  const Simulated& pass;
  std::vector<AnySample> samples;
  std::chrono::microseconds pause;
  std::string table;
};

/// Serves the whole pass into `db`.
/// @param kill_at Number of stored samples of `sent.table` after which the service is killed and
/// started again; 0: it is not.
void serve(const Sent& sent, const std::filesystem::path& db, std::int64_t kill_at) {
  const bus::BusConfig bus = bus_of_its_own();
  const Words words = on(bus, {"serve", "--mission", sent.pass.mission(), "--db", db});
  auto service = std::make_unique<Serving>(words);
  std::thread sender{[&] { EXPECT_TRUE((AnyFrontEnd{bus, sent.samples}.send(sent.pause))); }};
  if (kill_at > 0) {
    EXPECT_TRUE(eventually([&] { return count_rows(db, sent.table) >= kill_at; }));
    service->signal(SIGKILL);
    EXPECT_EQ(service->exit_status(), -1);
    service = std::make_unique<Serving>(words);
  }
  sender.join();
  EXPECT_TRUE(eventually([&] { return count_rows(db, "stream_silence") > 0; }));
  stop_in_order(*service);
  EXPECT_EQ(count_rows(db, "stream_silence"), 1) << service->log();
  EXPECT_EQ(count_rows(db, "alert WHERE key = 'link.silent' AND state <> 'active'"), 0);
}

/// Returns a share of a pass from which the lease is over before its end.
double random_share() {
  static std::random_device device;
  return std::uniform_real_distribution<double>{0.1, 0.6}(device);
}

class RestartAtSpeed : public ::testing::TestWithParam<Speed> {
 protected:
  /// @param late Rows of samples that came too late, of which there must be some.
  static void expect_no_row_changed(const Sent& sent, const std::string& late) {
    const TemporaryFolder folder;
    const auto whole = folder.path() / "whole.db";
    serve(sent, whole, 0);
    EXPECT_GT(count_rows(whole, late), 0);
    const std::vector<std::string> rows = all_rows(whole);
    const auto samples = static_cast<double>(count_rows(whole, sent.table));
    for (int kill = 0; kill < kKills; ++kill) {
      const auto db = folder.path() / fmt::format("killed-{}.db", kill);
      const std::int64_t kill_at = std::llround(samples * random_share());
      SCOPED_TRACE(fmt::format("killed after {} of {} samples", kill_at, samples));
      serve(sent, db, kill_at);
      std::vector<std::string> differing;
      std::ranges::set_symmetric_difference(all_rows(db), rows, std::back_inserter(differing));
      EXPECT_THAT(differing, ::testing::IsEmpty());
    }
  }

  /// @param table Table of the samples by which kills are timed.
  static Sent sent(const Simulated& pass, const std::string& spacecraft, const std::string& table) {
    std::vector<AnySample> samples = dirty(samples_in(pass.pass, spacecraft));
    const std::chrono::duration<double> pause{std::stod(GetParam().length_s) / GetParam().times /
                                              static_cast<double>(samples.size())};
    return {.pass = pass,
            .samples = std::move(samples),
            .pause = std::chrono::duration_cast<std::chrono::microseconds>(pause),
            .table = table};
  }
};

TEST_P(RestartAtSpeed, OfASpinnerWithDirtyShuffledAndRepeatedEdgesChangesNoRow) {
  const Simulated pass{"gto-dirty.toml",
                       {{"duration_s = 600.0", "duration_s = " + GetParam().length_s},
                        {"[[faults.silence]]\nfrom_s = 200.0\nto_s = 260.0\n", ""}}};
  expect_no_row_changed(sent(pass, "SPINNER", "pulse"), "pulse_use WHERE rejected_by = 'late'");
}

TEST_P(RestartAtSpeed, OfAThreeAxisSpacecraftWithShuffledAndRepeatedSamplesChangesNoRow) {
  const Simulated pass{"tumbling.toml",
                       {{"duration_s = 1800.0", "duration_s = " + GetParam().length_s},
                        {"first_star_fix_s = 1200.0", "first_star_fix_s = 10.0"}}};
  expect_no_row_changed(sent(pass, "LOSTSAT", "gyro_sample"),
                        "rejected_sample WHERE rejected_by = 'late'");
}

INSTANTIATE_TEST_SUITE_P(At, RestartAtSpeed,
                         ::testing::Values(Speed{1.0, "40.0"}, Speed{12.0, "400.0"},
                                           Speed{60.0, "1000.0"}),
                         [](const auto& speed) {
                           return std::to_string(static_cast<int>(speed.param.times));
                         });

}  // namespace spindrift::restart_at_speed_test
