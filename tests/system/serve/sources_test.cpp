#include <algorithm>
#include <chrono>
#include <iterator>
#include <string>
#include <vector>

#include "pipelines/time/time_span.h"
#include "services/base/wall_clock.h"
#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"

namespace spindrift::serve_sources_test {

using namespace std::chrono_literals;
using ::testing::ContainsRegex;

std::vector<Pulse> alien_pulses(TaiTime first, int count) {
  std::vector<Pulse> pulses;
  for (int i = 0; i < count; ++i) {
    pulses.push_back({.t = first + i * 100ms, .channel = PulseChannel::Sun1});
  }
  return pulses;
}

std::vector<std::string> sorted(std::vector<std::string> rows) {
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Runs a service with a pass of one honest source, and holds the undisturbed result. The pass is a
/// recorded one, sent faster than real time.
class ServeSources : public ::testing::Test {
 protected:
  explicit ServeSources(const std::string& partition = "replay") : service_{"nominal", partition} {
    whole();
  }

  struct Whole {
    std::vector<Pulse> pulses;
    std::vector<std::string> products;
    std::vector<std::string> batch;
  };

  static const Whole& whole() {
    static const Whole kWhole = [] {
      Whole whole{.pulses = pulses_of("nominal"), .products = {}, .batch = {}};
      ReadyService service{"nominal", "replay"};
      EXPECT_TRUE((FrontEnd{service.bus(), "SPINNER", whole.pulses}.send_until(1.0)));
      EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
      whole.products = sorted(product_rows(service.db()));
      whole.batch = last_batch_rows(service.db());
      return whole;
    }();
    return kWhole;
  }

  FrontEnd honest() const { return {service_.bus(), "SPINNER", whole().pulses}; }

  void send_alien(TaiTime first, int count) const {
    ASSERT_TRUE(
        (FrontEnd{service_.bus(), "SPINNER", alien_pulses(first, count), "alien"}.send_until(1.0)));
  }

  std::int64_t number(const std::string& query) const { return number_of(service_.db(), query); }

  bool has_stored(std::size_t pulses) const {
    return eventually(
        [&] { return number("SELECT count(*) FROM pulse") == static_cast<std::int64_t>(pulses); });
  }

  /// Expects the result of the honest source alone, in one run.
  void expect_the_whole_pass() {
    ASSERT_EQ(service_.stop_when_computed(), 0) << service_.log();
    const std::vector<std::string> rows = sorted(product_rows(service_.db()));
    std::vector<std::string> missing;
    std::set_difference(whole().products.begin(), whole().products.end(), rows.begin(), rows.end(),
                        std::back_inserter(missing));
    EXPECT_THAT(missing, IsEmpty()) << service_.log();
    EXPECT_EQ(last_batch_rows(service_.db()), whole().batch) << service_.log();
    EXPECT_EQ(number("SELECT count(*) FROM pulse_use WHERE rejected_by IN ('late', 'out_of_time') "
                     "AND t_tai_ns <= " +
                     std::to_string(tai_ns(whole().pulses.back().t))),
              0)
        << service_.log();
    EXPECT_EQ(number("SELECT count(DISTINCT run_id) FROM spin_estimate"), 1) << service_.log();
  }

  ReadyService service_;
};

struct AlienBefore {
  int count;
  bool computed;  ///< Whether the samples are processed before the honest source sends anything.
};

class ServeAlienBefore : public ServeSources, public ::testing::WithParamInterface<AlienBefore> {};

TEST_P(ServeAlienBefore, CostsTheHonestSourceNothing) {
  const auto& [count, computed] = GetParam();
  send_alien(whole().pulses.front().t + 2h, count);
  if (computed) {
    ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM stream_silence") == 1; }));
  }
  FrontEnd front_end = honest();
  ASSERT_TRUE(front_end.send_until(1.0));
  ASSERT_TRUE(has_stored(whole().pulses.size() + static_cast<std::size_t>(count)));
  ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM run") == 2; }))
      << service_.log();
  service_.kill_and_go_on();
  expect_the_whole_pass();
  EXPECT_THAT(service_.log(), AllOf(HasSubstr("a new run begins with source 'front-end'"),
                                    HasSubstr("behind source 'alien'")));
}

INSTANTIATE_TEST_SUITE_P(Alien, ServeAlienBefore,
                         ::testing::Values(AlienBefore{8, true}, AlienBefore{100, false}),
                         [](const auto& test) {
                           return (test.param.computed ? "Computed" : "Burst") +
                                  std::to_string(test.param.count);
                         });

struct AlienWithin {
  int count;
  std::chrono::minutes ahead;
};

/// Runs a live service, in which a pause in sending is no silence.
class ServeAlienWithin : public ServeSources, public ::testing::WithParamInterface<AlienWithin> {
 protected:
  ServeAlienWithin() : ServeSources{""} {}
};

TEST_P(ServeAlienWithin, IsLeftOutAndNamed) {
  const auto& [count, ahead] = GetParam();
  const std::size_t half = whole().pulses.size() / 2;
  FrontEnd front_end = honest();
  ASSERT_TRUE(front_end.send_until(0.5));
  send_alien(whole().pulses.at(half).t + ahead, count);
  ASSERT_TRUE(front_end.send_until(0.75));
  ASSERT_TRUE(has_stored(half + half / 2 + static_cast<std::size_t>(count)));
  EXPECT_TRUE(eventually([&] {
    return number("SELECT count(*) FROM alert WHERE key = 'clock.disagree'") == 1;
  })) << "a recorded pass is not of the host's time";
  // A kill would lose the message if it was not logged yet.
  EXPECT_TRUE(service_.program().says("SPINNER: the samples of source 'alien' (session "));
  service_.kill_and_go_on();
  ASSERT_TRUE(front_end.send_until(1.0));
  expect_the_whole_pass();
  EXPECT_EQ(number("SELECT count(*) FROM run"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM pulse WHERE arrival < 0 AND source = 'alien'"), count);
  EXPECT_EQ(number("SELECT count(*) FROM pulse WHERE arrival < 0"), count);
  EXPECT_THAT(service_.log(), HasSubstr("SPINNER: the samples of source 'alien' (session "));
}

INSTANTIATE_TEST_SUITE_P(Alien, ServeAlienWithin,
                         ::testing::Values(AlienWithin{8, 2h}, AlienWithin{100, 10min}),
                         [](const auto& test) {
                           return std::to_string(test.param.count) + "By" +
                                  std::to_string(test.param.ahead.count()) + "Minutes";
                         });

TEST_F(ServeSources, OneThatHealsIsOneOfThemAgain) {
  const std::size_t half = whole().pulses.size() / 2;
  const auto middle = whole().pulses.begin() + static_cast<std::ptrdiff_t>(half);
  std::vector<Pulse> pulses = alien_pulses(middle->t + 2h, 20);
  pulses.insert(pulses.end(), middle, middle + 40);
  FrontEnd front_end = honest();
  ASSERT_TRUE(front_end.send_until(0.5));
  ASSERT_TRUE((FrontEnd{service_.bus(), "SPINNER", pulses, "healing"}.send_until(1.0)));
  ASSERT_TRUE(front_end.send_until(1.0));
  expect_the_whole_pass();
  EXPECT_EQ(number("SELECT count(*) FROM run"), 1);
  EXPECT_THAT(service_.log(), ContainsRegex("source 'healing' .*agrees with the others again"));
}

TEST_F(ServeSources, OneHandsOverToAnother) {
  FrontEnd front_end = honest();
  ASSERT_TRUE(front_end.send_until(0.5));
  ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM stream_silence") == 1; }));
  const auto middle =
      whole().pulses.begin() + static_cast<std::ptrdiff_t>(whole().pulses.size() / 2);
  ASSERT_TRUE(
      (FrontEnd{service_.bus(), "SPINNER", {middle, whole().pulses.end()}, "other"}.send_until(
          1.0)));
  expect_the_whole_pass();
  EXPECT_EQ(number("SELECT count(*) FROM run"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM pulse WHERE arrival < 0"), 0);
  EXPECT_THAT(service_.log(), Not(HasSubstr("left out")));
}

TEST_F(ServeSources, OneThatBeginsWithItsLastMinutesCatchesUp) {
  FrontEnd front_end = honest();
  ASSERT_TRUE(front_end.send_until(0.75));
  FrontEnd other{service_.bus(), "SPINNER", whole().pulses, "other"};
  ASSERT_TRUE(other.send_until(1.0));
  ASSERT_TRUE(has_stored(whole().pulses.size()));
  ASSERT_EQ(service_.stop_when_computed(), 0) << service_.log();
  const std::string log = service_.log();
  EXPECT_EQ(number("SELECT count(*) FROM run"), 1) << log;
  EXPECT_EQ(number("SELECT count(*) FROM pulse WHERE arrival < 0"), 0) << log;
  EXPECT_EQ(last_batch_rows(service_.db()), whole().batch) << log;
}

/// Runs a live service, which front-ends tell of the present.
class ServeByTheHost : public ::testing::Test {
 protected:
  static std::vector<Pulse> pulses(std::chrono::nanoseconds off) {
    return alien_pulses(later_by(tai_now(), off), 100);
  }

  /// Sends a hundred pulses of each, the honest source last.
  void send() const {
    for (const std::string liar : {"one", "two", "three"}) {
      ASSERT_TRUE((FrontEnd{service_.bus(), "SPINNER", pulses(2h), liar}.send_until(1.0)));
    }
    ASSERT_TRUE((FrontEnd{service_.bus(), "SPINNER", pulses(-10s), "honest"}.send_until(1.0)));
  }

  std::int64_t number(const std::string& query) const { return number_of(service_.db(), query); }

  bool has_taken(std::int64_t honest) const {
    return eventually([&] {
      return number("SELECT count(*) FROM pulse WHERE source = 'honest' AND arrival > 0") == honest;
    });
  }

  ReadyService service_{"nominal"};
};

TEST_F(ServeByTheHost, NoNumberOfSourcesOutvotesTheOneThatIsInTime) {
  send();
  EXPECT_TRUE(has_taken(100)) << service_.log();
  service_.kill_and_go_on();
  send();
  EXPECT_TRUE(has_taken(200)) << service_.log();
  ASSERT_EQ(service_.stop_when_computed(), 0) << service_.log();
  EXPECT_EQ(number("SELECT count(*) FROM pulse WHERE source <> 'honest' AND arrival < 0 AND"
                   " arrival < -(SELECT max(first_arrival) FROM run)"),
            300)
      << service_.log();
  EXPECT_EQ(number("SELECT count(*) FROM source_clock WHERE source IS NULL"), 0)
      << "the run of the host's clock needs no row";
}

}  // namespace spindrift::serve_sources_test
