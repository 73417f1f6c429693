#include "pipelines/supervision/service_conditions.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>

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
          .data_until = {{"orbit", at(1e6)}}};
}

/// Checks the conditions once a second and holds the severity of each active key.
struct Supervised {
  ServiceConditions conditions;
  std::map<std::string, std::string_view> raised = {};

  explicit Supervised(std::optional<Contact> contact = std::nullopt)
      : conditions{AlertLimits{}, contact} {}

  void see(const ServiceState& state) {
    for (const ConditionChange& change : conditions.see(state)) {
      const std::string key = alert_key(change.code, change.about);
      if (change.change == Change::Raised) {
        raised.emplace(key, name_of(change.severity));
      } else {
        raised.erase(key);
      }
    }
  }
  /// @param spoil Changes the state of each second.
  template <class Spoil>
  void see(int from_s, int to_s, const Spoil& spoil) {
    for (int t_s = from_s; t_s < to_s; ++t_s) {
      ServiceState one = state(t_s);
      spoil(one, t_s);
      see(one);
    }
  }
};

using Raised = std::map<std::string, std::string_view>;
const auto kWell = [](ServiceState& /*state*/, int /*t_s*/) {};
const auto kSilentFrom10 = [](ServiceState& one, int t_s) { one.silent_s = t_s - 10.0; };

TEST(ServiceConditions, RaiseNothingOfAServiceThatIsWell) {
  Supervised service;
  service.see(0, 200, kWell);
  EXPECT_EQ(service.raised, Raised{});
}

TEST(ServiceConditions, RaiseSilenceAndClearItWhenTelemetryIsBack) {
  Supervised service;
  service.see(10, 15, kSilentFrom10);
  EXPECT_EQ(service.raised, Raised{});
  service.see(15, 16, kSilentFrom10);
  EXPECT_EQ(service.raised, (Raised{{"link.silent", "warning"}}));
  service.see(16, 17, [](ServiceState& one, int /*t_s*/) { one.silent_s.reset(); });
  EXPECT_EQ(service.raised, (Raised{{"link.silent", "warning"}}));
  service.see(17, 18, kWell);
  EXPECT_EQ(service.raised, Raised{});
}

TEST(ServiceConditions, ExpectTelemetryWithinAPlannedContactOnly) {
  Supervised service{Contact{.from = at(100.0), .to = at(200.0)}};
  service.see(10, 104, kSilentFrom10);
  EXPECT_EQ(service.raised, Raised{});
  service.see(104, 106, kSilentFrom10);
  EXPECT_EQ(service.raised, (Raised{{"link.silent", "critical"}}));
  service.see(106, 200, kSilentFrom10);
  EXPECT_EQ(service.raised.size(), 1U);
  service.see(200, 202, kSilentFrom10);
  EXPECT_EQ(service.raised, Raised{});
}

TEST(ServiceConditions, RaiseTelemetryThatIsLateOrAhead) {
  Supervised service;
  service.see(0, 2, [](ServiceState& one, int /*t_s*/) { one.late_s = 12.0; });
  EXPECT_EQ(service.raised, Raised{});
  service.see(2, 4, [](ServiceState& one, int /*t_s*/) { one.late_s = 12.0; });
  EXPECT_EQ(service.raised, (Raised{{"link.late", "warning"}}));
  service.see(4, 8, [](ServiceState& one, int /*t_s*/) { one.late_s = -12.0; });
  EXPECT_EQ(service.raised, (Raised{{"link.ahead", "warning"}}));
  service.see(8, 12, [](ServiceState& one, int /*t_s*/) { one.late_s.reset(); });
  EXPECT_EQ(service.raised.size(), 1U);
}

TEST(ServiceConditions, RaiseWhatASourceDidWithinTheLastMinute) {
  Supervised service;
  const auto did = [](ServiceState& one, int t_s) {
    if (t_s >= 10) {
      one.sources["front-end"] = {.missing = 1, .restarts = 1, .repeated = 100};
    }
  };
  service.see(0, 11, did);
  EXPECT_EQ(service.raised, (Raised{{"link.gap:front-end", "warning"},
                                    {"link.repeated:front-end", "info"},
                                    {"link.restarted:front-end", "info"}}));
  service.see(11, 70, did);
  EXPECT_EQ(service.raised.size(), 3U);
  service.see(70, 71, did);
  EXPECT_EQ(service.raised, Raised{});
}

TEST(ServiceConditions, ClearAGapThatIsFilled) {
  Supervised service;
  const auto is_missing = [](ServiceState& one, int t_s) {
    one.sources["front-end"].missing = t_s < 10 ? 3 : 0;
  };
  service.see(0, 10, is_missing);
  EXPECT_EQ(service.raised.size(), 1U);
  service.see(10, 11, is_missing);
  EXPECT_EQ(service.raised, Raised{});
}

TEST(ServiceConditions, RaiseTheShareOfImpossibleSamples) {
  Supervised service;
  service.see(0, 100, kWell);
  service.see(100, 101, [](ServiceState& one, int /*t_s*/) { one.rejected = 3; });
  EXPECT_EQ(service.raised, Raised{});
  service.see(101, 102, [](ServiceState& one, int /*t_s*/) { one.rejected = 4; });
  EXPECT_EQ(service.raised, (Raised{{"link.rejected", "warning"}}));
}

TEST(ServiceConditions, RaiseWhatIsWrongWithTheServiceAndItsHost) {
  Supervised service;
  service.see(0, 1, [](ServiceState& one, int /*t_s*/) {
    one.other_service = "another";
    one.backlog_s = 10.0;
    one.write_failed = true;
    one.free_gib = 0.5;
    one.clock_step_s = -3600.0;
    one.data_until = {{"orbit", at(3600.0)}, {"leap_seconds", at(0.0)}};
  });
  EXPECT_EQ(service.raised, (Raised{{"archive.backlog", "warning"},
                                    {"archive.disk", "warning"},
                                    {"archive.write", "critical"},
                                    {"clock.jump", "warning"},
                                    {"data.outdated:leap_seconds", "warning"},
                                    {"data.outdated:orbit", "warning"},
                                    {"service.twice", "warning"}}));
  service.see(1, 2,
              [](ServiceState& one, int /*t_s*/) { one.data_until["leap_seconds"] = at(1e6); });
  EXPECT_EQ(service.raised, (Raised{{"clock.jump", "warning"}}));
  service.see(2, 63, kWell);
  EXPECT_EQ(service.raised, Raised{});
}

}  // namespace spindrift::service_conditions_test
