#include "pipelines/supervision/service_conditions.h"

#include <map>
#include <optional>
#include <string>

#include "tests/support/matchers.h"

namespace spindrift::service_conditions_test {

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
TaiTime at(double t_s) { return shifted(kStart, t_s); }

/// Returns a healthy service and link.
ServiceState state(double t_s) {
  return {.t = at(t_s),
          .pass_t = at(t_s),
          .silent_s = 0.1,
          .late_s = 0.2,
          .sources = {{"front-end", {}}},
          .received = static_cast<std::int64_t>(6.0 * t_s),
          .free_gib = 20.0,
          .data_ends = {{"orbit", {at(1e6)}}}};
}

/// Checks the conditions once a second and holds the severity of each active key.
struct Supervised {
  ServiceConditions conditions;
  std::map<std::string, std::string_view> raised = {};

  explicit Supervised(std::optional<Contact> contact = std::nullopt)
      : conditions{AlertLimits{}, contact} {}

  void evaluate(const ServiceState& state) {
    for (const ConditionChange& change : conditions.evaluate(state)) {
      const std::string key = alert_key(change.code, change.about);
      if (change.change == Change::Raised) {
        raised.emplace(key, name_of(change.severity));
      } else if (change.change == Change::Cleared) {
        raised.erase(key);
      }
    }
  }
  /// @param spoil Changes the state of each second.
  /// @return What is raised then.
  template <class Spoil>
  const std::map<std::string, std::string_view>& evaluate(int from_s, int to_s,
                                                          const Spoil& spoil) {
    for (int t_s = from_s; t_s < to_s; ++t_s) {
      ServiceState one = state(t_s);
      spoil(one, t_s);
      evaluate(one);
    }
    return raised;
  }
};

using Raised = std::map<std::string, std::string_view>;
const auto kWell = [](ServiceState& /*state*/, int /*t_s*/) {};
const auto kSilentFrom10 = [](ServiceState& one, int t_s) { one.silent_s = t_s - 10.0; };

class ServiceConditionsTest : public ::testing::Test {
 protected:
  Supervised service_;
};

TEST_F(ServiceConditionsTest, RaiseNothingOfAServiceThatIsWell) {
  EXPECT_EQ(service_.evaluate(0, 200, kWell), Raised{});
}

TEST_F(ServiceConditionsTest, RaiseSilenceAndClearItWhenTelemetryIsBack) {
  EXPECT_EQ(service_.evaluate(10, 15, kSilentFrom10), Raised{});
  EXPECT_EQ(service_.evaluate(15, 16, kSilentFrom10), (Raised{{"link.silent", "warning"}}));
  EXPECT_EQ(service_.evaluate(16, 17, [](auto& one, int /*t_s*/) { one.silent_s.reset(); }),
            (Raised{{"link.silent", "warning"}}));
  EXPECT_EQ(service_.evaluate(17, 18, kWell), Raised{});
}

TEST_F(ServiceConditionsTest, ExpectTelemetryWithinAPlannedContactOnly) {
  Supervised service{Contact{.from = at(100.0), .to = at(200.0)}};
  EXPECT_EQ(service.evaluate(10, 104, kSilentFrom10), Raised{});
  EXPECT_EQ(service.evaluate(104, 106, kSilentFrom10), (Raised{{"link.silent", "critical"}}));
  EXPECT_EQ(service.evaluate(106, 200, kSilentFrom10).size(), 1U);
  EXPECT_EQ(service.evaluate(200, 202, kSilentFrom10), Raised{});
}

TEST_F(ServiceConditionsTest, RaiseTelemetryThatIsLateOrAhead) {
  EXPECT_EQ(service_.evaluate(0, 2, [](auto& one, int /*t_s*/) { one.late_s = 12.0; }), Raised{});
  EXPECT_EQ(service_.evaluate(2, 4, [](auto& one, int /*t_s*/) { one.late_s = 12.0; }),
            (Raised{{"link.late", "warning"}}));
  EXPECT_EQ(service_.evaluate(4, 8, [](auto& one, int /*t_s*/) { one.late_s = -12.0; }),
            (Raised{{"link.ahead", "warning"}}));
  EXPECT_EQ(service_.evaluate(8, 12, [](auto& one, int /*t_s*/) { one.late_s.reset(); }).size(),
            1U);
  const auto two_hours_ahead = [](auto& one, int /*t_s*/) { one.late_s = -7200.0; };
  EXPECT_EQ(service_.evaluate(12, 15, two_hours_ahead),
            (Raised{{"clock.disagree", "warning"}, {"link.ahead", "warning"}}));
}

TEST_F(ServiceConditionsTest, RaiseWhatASourceDidWithinTheLastMinute) {
  const auto did = [](ServiceState& one, int t_s) {
    if (t_s >= 10) {
      one.sources["front-end"] = {.missing = 1, .restarts = 1, .repeated = 100};
    }
  };
  EXPECT_EQ(service_.evaluate(0, 11, did), (Raised{{"link.gap:front-end", "warning"},
                                                   {"link.repeated:front-end", "info"},
                                                   {"link.restarted:front-end", "info"}}));
  EXPECT_EQ(service_.evaluate(11, 70, did).size(), 3U);
  EXPECT_EQ(service_.evaluate(70, 71, did), Raised{});
}

TEST_F(ServiceConditionsTest, ClearAGapThatIsFilled) {
  const auto is_missing = [](ServiceState& one, int t_s) {
    one.sources["front-end"].missing = t_s < 10 ? 3 : 0;
  };
  EXPECT_EQ(service_.evaluate(0, 10, is_missing).size(), 1U);
  EXPECT_EQ(service_.evaluate(10, 11, is_missing), Raised{});
}

TEST_F(ServiceConditionsTest, RaiseTheShareOfImpossibleSamples) {
  service_.evaluate(0, 100, kWell);
  EXPECT_EQ(service_.evaluate(100, 101, [](auto& one, int /*t_s*/) { one.rejected = 3; }),
            Raised{});
  EXPECT_EQ(service_.evaluate(101, 102, [](auto& one, int /*t_s*/) { one.rejected = 4; }),
            (Raised{{"link.rejected", "warning"}}));
}

TEST_F(ServiceConditionsTest, RaiseWhatIsWrongWithTheServiceAndItsHost) {
  service_.evaluate(0, 1, [](auto& one, int /*t_s*/) {
    one.other_service = "another";
    one.undelivered_s = 60.0;
    one.backlog_s = 10.0;
    one.write_failed = true;
    one.free_gib = 0.5;
    one.log_mib = 256.0;
    one.clock_step_s = -3600.0;
    one.data_ends = {{"orbit", {at(3600.0)}}, {"leap_seconds", {at(0.0), AlertSeverity::Info}}};
  });
  EXPECT_EQ(service_.raised, (Raised{{"alerts.undelivered", "warning"},
                                     {"archive.backlog", "warning"},
                                     {"archive.disk", "warning"},
                                     {"archive.log", "warning"},
                                     {"archive.write", "critical"},
                                     {"clock.jump", "warning"},
                                     {"data.outdated:leap_seconds", "info"},
                                     {"data.outdated:orbit", "warning"},
                                     {"service.twice", "warning"}}));
  service_.evaluate(1, 2,
                    [](auto& one, int /*t_s*/) { one.data_ends["leap_seconds"] = {at(1e6)}; });
  EXPECT_EQ(service_.raised, (Raised{{"clock.jump", "warning"}}));
  EXPECT_EQ(service_.evaluate(2, 63, kWell), Raised{});
}

}  // namespace spindrift::service_conditions_test
