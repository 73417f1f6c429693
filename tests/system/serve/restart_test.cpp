#include <spindrift.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "services/bus/qos.h"
#include "services/publisher/product_messages.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/program.h"
#include "tests/support/recorded_files.h"
#include "tests/support/service.h"
#include "tests/support/subscriber.h"

namespace spindrift::serve_restart_test {

using namespace std::chrono_literals;

TEST(Serve, LeavesAWholeArchiveWhenKilled) {
  ReadyService service{"gms5"};
  Program replay{service.words({"replay", "--telemetry", kPasses / "gms5", "--speed", "100"})};
  ASSERT_TRUE(eventually([&] {
    return std::filesystem::exists(service.db()) && count_rows(service.db(), "spin_estimate") > 50;
  }));
  service.kill();
  replay.signal(SIGKILL);

  EXPECT_THAT(rows_of(service.db(), "PRAGMA integrity_check"), ElementsAre("ok|"));
  EXPECT_THAT(rows_of(service.db(), "PRAGMA foreign_key_check"), IsEmpty());
  // The edges of a source are counted in the transaction that stores them.
  EXPECT_EQ(number_of(service.db(), "SELECT received FROM source_count"),
            count_rows(service.db(), "pulse"));
  // No result may exist without the edges that it is based on.
  EXPECT_EQ(count_rows(service.db(),
                       "pulse_use LEFT JOIN pulse USING (spacecraft_id, t_tai_ns, channel) WHERE "
                       "pulse.t_tai_ns IS NULL"),
            0);
}

/// The parameter is the signal that ends the service.
class ServeRestart : public ::testing::TestWithParam<int> {
 protected:
  static void restart(ReadyService& service) {
    service.program().signal(GetParam());
    ASSERT_EQ(service.program().exit_status(), GetParam() == SIGKILL ? -1 : 0);
    service.go_on();
  }
};

TEST_P(ServeRestart, TellsHowFarTelemetryHadCome) {
  ReadyService service{"nominal"};
  ASSERT_TRUE((FrontEnd{service.bus(), "SPINNER", pulses_of("nominal")}.send_until(0.1)));
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") == 360; }));
  restart(service);

  const Subscriber health{service.bus(), bus::kHealthTopic};
  std::vector<spindrift_SpacecraftHealth> links;
  ASSERT_TRUE(eventually([&] {
    health.take([&](const spindrift_Health& beat) { links.push_back(beat.spacecraft._buffer[0]); });
    return !links.empty();
  }));
  EXPECT_EQ(links.back().link, spindrift_LINK_STALE);
  EXPECT_EQ(links.back().last_sample_tai_ns,
            number_of(service.db(), "SELECT max(t_tai_ns) FROM pulse"));
  EXPECT_TRUE(std::isnan(links.back().data_age_s));
}

/// Returns the pulses with every 97th sent 50 later, either late by seconds or within the reorder
/// window.
std::vector<Pulse> disordered_pulses(const std::string& pass) {
  std::vector<Pulse> pulses = pulses_of(pass);
  for (std::size_t i = 0; i + 50 < pulses.size(); i += 97) {
    const auto first = pulses.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(first, first + 1, first + 50);
  }
  return pulses;
}

TEST_P(ServeRestart, IntoARunningPassGivesWhatNoRestartWouldHave) {
  const std::vector<Pulse> pulses = disordered_pulses("gms5");
  ReadyService whole{"gms5"};
  ASSERT_TRUE((FrontEnd{whole.bus(), "GMS-5", pulses}.send_until(1.0)));
  ASSERT_EQ(whole.stop_when_computed(), 0) << whole.log();
  ASSERT_GT(count_rows(whole.db(), "pulse_use WHERE rejected_by = 'late'"), 0);

  ReadyService service{"gms5"};
  FrontEnd front_end{service.bus(), "GMS-5", pulses};
  for (const double share : {0.02, 0.5}) {
    ASSERT_TRUE(front_end.send_until(share));
    restart(service);
  }
  ASSERT_TRUE(front_end.send_until(1.0));
  EXPECT_TRUE(
      eventually([&] { return count_rows(service.db(), "run WHERE finished_utc IS NULL") == 1; }));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();

  EXPECT_THAT(service.log(), HasSubstr("continuing run"));
  EXPECT_EQ(count_rows(service.db(), "run WHERE finished_utc IS NOT NULL"), 1);
  EXPECT_EQ(product_rows(service.db()), product_rows(whole.db()));
  EXPECT_EQ(last_batch_rows(service.db()), last_batch_rows(whole.db()));
  const auto report = service.summary();
  EXPECT_EQ(report["runs"][0]["revolutions"], whole.summary()["runs"][0]["revolutions"]);
}

/// Holds what a KEEP_ALL subscriber received, by kind: revolution numbers of fixes, and times of
/// the estimates of each estimator.
using Announced = std::map<std::string, std::vector<std::int64_t>>;

struct Listener {
  explicit Listener(const bus::BusConfig& bus)
      : fixes{bus, product_topic<SpinFix>(), bus::telemetry_reader_qos()},
        estimates{bus, product_topic<SpinEstimate>(), bus::telemetry_reader_qos()} {}

  Announced take_all() const {
    Announced all;
    const auto take_fix = [&](const spindrift_SpinFix& fix) {
      all["fix"].push_back(fix.revolution);
    };
    const auto take_estimate = [&](const spindrift_SpinEstimate& estimate) {
      all[estimate.estimator].push_back(estimate.t_tai_ns);
    };
    while (fixes.take(take_fix) > 0 || estimates.take(take_estimate) > 0) {
    }
    return all;
  }

  Subscriber<spindrift_SpinFix> fixes;
  Subscriber<spindrift_SpinEstimate> estimates;
};

int most_alike(const std::vector<std::int64_t>& times) {
  std::map<std::int64_t, int> count;
  int most = 0;
  for (const std::int64_t t : times) {
    most = std::max(most, ++count[t]);
  }
  return most;
}

TEST_P(ServeRestart, AnnouncesNothingTwiceButWhatIsInForce) {
  const std::vector<Pulse> pulses = pulses_of("nominal");
  ReadyService service{"nominal"};
  const Listener listener{service.bus()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses};
  for (const auto& [share, fixes] : {std::pair{0.3, 150}, std::pair{0.6, 300}}) {
    ASSERT_TRUE(front_end.send_until(share));
    ASSERT_TRUE(eventually(
        [db = service.db(), least = fixes] { return count_rows(db, "spin_fix") > least; }));
    restart(service);
  }
  ASSERT_TRUE(front_end.send_until(1.0));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();

  const Announced announced = listener.take_all();
  ASSERT_EQ(announced.size(), 4U);
  for (const auto& [kind, times] : announced) {
    const std::set<std::int64_t> different{times.begin(), times.end()};
    if (kind == "batch") {
      // A start withdraws batch solutions and computes them again. If it is stopped before, the
      // next start cannot know that they were announced. The periodic solution may come after
      // that of an orderly stop.
      EXPECT_LE(most_alike(times), service.starts()) << kind;
    } else {
      EXPECT_LE(std::ssize(times), std::ssize(different) + service.starts() - 1) << kind;
      EXPECT_TRUE(std::is_sorted(times.begin(), times.end())) << kind;
    }
  }
  const std::vector<std::int64_t>& fixes = announced.at("fix");
  if (GetParam() == SIGTERM) {
    EXPECT_EQ((std::set<std::int64_t>{fixes.begin(), fixes.end()}.size()),
              count_rows(service.db(), "spin_fix WHERE accepted"));
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, ServeRestart, ::testing::Values(SIGKILL, SIGTERM),
                         [](const auto& signal) {
                           return signal.param == SIGKILL ? "Kill" : "Term";
                         });

TEST(Serve, PublishesWhatIsInForceAgainAfterARestart) {
  Service service{"nominal"};
  ASSERT_TRUE(service.serves_its_pass()) << service.log();
  service.start();
  const Subscriber estimates{service.bus(), product_topic<SpinEstimate>()};
  ASSERT_FALSE(take_samples(estimates.reader(), 1).empty());
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
}

TEST(Serve, CountsMissingSamplesOnceHoweverOftenTheyAreSentAgain) {
  ReadyService service{"nominal"};
  const auto participant = bus::Participant::create(service.bus()).value();
  const auto front_end = telemetry_writer<Pulse>(participant);
  const std::set<std::uint64_t> withheld = {100, 101, 102, 103, 250, 251, 400};
  const auto send = [&](std::uint64_t from, std::uint64_t end) {
    for (std::uint64_t seq = from; seq < end; ++seq) {
      if (!withheld.contains(seq)) {
        ASSERT_TRUE(front_end.write(idl_pulse(seq)));
      }
    }
  };
  const auto gaps_when_stopped_after = [&](std::uint64_t last) {
    EXPECT_TRUE(eventually([&] {
      return number_of(service.db(), "SELECT max(seq) FROM pulse") ==
             static_cast<std::int64_t>(last);
    }));
    EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
    return number_of(service.db(), "SELECT gaps FROM source_count");
  };
  send(0, 200);
  EXPECT_EQ(gaps_when_stopped_after(199), 4);
  send(200, 300);  // The service is not running and receives these later.
  service.go_on();
  send(300, 500);
  EXPECT_EQ(gaps_when_stopped_after(499), 7);
  service.start();
  send(500, 501);
  EXPECT_EQ(gaps_when_stopped_after(500), 7);
}

TEST(Serve, SaysWhenAChangedMissionFileBeginsANewRun) {
  const PassCopy pass{"nominal"};
  const bus::BusConfig bus = bus_of_its_own();
  const auto log_of_a_service = [&] {
    Serving service{on(bus, {"serve", "--mission", pass.mission(), "--db", pass.db})};
    stop_in_order(service);
    return service.log();
  };
  EXPECT_THAT(log_of_a_service(), Not(HasSubstr("have changed")));
  const std::string run = rows_of(pass.db, "SELECT run_id FROM run").at(0);
  EXPECT_THAT(log_of_a_service(), HasSubstr("continuing run"));
  std::ofstream{pass.mission(), std::ios::app} << "\n# better known now\n";
  EXPECT_THAT(log_of_a_service(), HasSubstr("since run " + run.substr(0, run.size() - 1) +
                                            " these have changed: the mission file\n"));
}

/// Returns two passes with one revolution a second, just over an hour apart.
std::vector<Pulse> two_passes() {
  std::vector<Pulse> pulses;
  for (const std::int64_t first_s : {0, 3700}) {
    for (std::int64_t t_s = first_s; t_s < first_s + 100; ++t_s) {
      pulses.push_back({.t = tai_from_ns(kTestTime_tai_ns + t_s * 1'000'000'000),
                        .channel = PulseChannel::Sun1});
    }
  }
  return pulses;
}

/// The parameter is the share of `two_passes` after which the service restarts; 1 for no restart.
class ServeTwoPasses : public ::testing::TestWithParam<double> {};

TEST_P(ServeTwoPasses, MakesTwoRunsHoweverTheServiceIsRestarted) {
  ReadyService service{"nominal"};
  const std::vector<Pulse> pulses = two_passes();
  FrontEnd front_end{service.bus(), "SPINNER", pulses};
  ASSERT_TRUE(front_end.send_until(GetParam()));
  if (GetParam() < 1.0) {
    ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
    service.start();
    // The front-end sends its last samples of the old pass again first, which must not end the
    // silence.
    ASSERT_TRUE(front_end.send_until(1.0));
  }
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();

  EXPECT_THAT(rows_of(service.db(),
                      "SELECT min(t_tai_ns), min(revolution), max(revolution), count(*) FROM "
                      "revolution GROUP BY run_id ORDER BY 1"),
              ElementsAre(std::to_string(tai_ns(pulses.at(0).t)) + "|0|99|100|",
                          std::to_string(tai_ns(pulses.at(100).t)) + "|0|99|100|"));
  EXPECT_EQ(count_rows(service.db(), "run WHERE finished_utc IS NOT NULL"), 2);
  EXPECT_THAT(rows_of(service.db(), "SELECT first_tai_ns FROM run ORDER BY first_arrival"),
              ElementsAre(std::to_string(tai_ns(pulses.at(0).t)) + "|",
                          std::to_string(tai_ns(pulses.at(100).t)) + "|"));
  EXPECT_EQ(count_rows(service.db(), "pulse_use"), 200);
}

// Restart before the silence, before the new pass is confirmed, and never.
INSTANTIATE_TEST_SUITE_P(After, ServeTwoPasses, ::testing::Values(0.5, 0.515, 1.0));

}  // namespace spindrift::serve_restart_test
