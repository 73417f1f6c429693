#include "services/base/alert_words.h"

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::alert_words_test {

const TaiTime kTime = tai_from_ns(1'795'143'637'000'000'000);

ConditionChange change(AlertCode code, Change change, double limit) {
  return {.code = code,
          .about = "",
          .change = change,
          .t = kTime,
          .evidence = {.value = 1.25,
                       .limit = limit,
                       .unit = "deg",
                       .since = kTime,
                       .last = kTime,
                       .sigma = std::nullopt}};
}

TEST(AlertWords, GiveValueLimitTimeAndWhatToDo) {
  EXPECT_EQ(sentence_of(change(AlertCode::SpinSigma, Change::Raised, 1.0)),
            "sigma of the answer in force: 1.25 deg, limit 1 at 2026-11-20T03:00:00.000Z: wait, or "
            "look which channels give nothing");
  EXPECT_EQ(sentence_of(change(AlertCode::AttitudeLost, Change::Raised, 0.0)),
            "the answer in force is LOST at 2026-11-20T03:00:00.000Z: do not use it; wait for the "
            "next accepted fix");
  EXPECT_EQ(sentence_of(change(AlertCode::SpinSigma, Change::Cleared, 1.0)),
            "over at 2026-11-20T03:00:00.000Z");
}

TEST(AlertWords, OfAConditionThatGoesOnHaveItsWorstItsBeginningAndItsCount) {
  auto renewed = change(AlertCode::SpinSigma, Change::Renewed, 1.0);
  renewed.evidence.worst = 2.5;
  renewed.evidence.since = shifted(kTime, -60.0);
  EXPECT_EQ(sentence_of(renewed, 3),
            "sigma of the answer in force: 1.25 deg, worst 2.5, limit 1 at "
            "2026-11-20T03:00:00.000Z, since 2026-11-20T02:59:00.000Z, 3 times so far: wait, or "
            "look which channels give nothing");
  const auto evidence = nlohmann::json::parse(evidence_json(renewed.evidence, "00ff", 3));
  EXPECT_EQ(evidence["worst"], 2.5);
  EXPECT_EQ(evidence["count"], 3);
}

TEST(AlertWords, GiveAMinuteAndMoreAsADuration) {
  auto late = change(AlertCode::LinkLate, Change::Raised, 30.0);
  late.evidence.unit = "s";
  late.evidence.value = 787'000.0;
  late.evidence.sigma.reset();
  EXPECT_THAT(sentence_of(late, 1), HasSubstr("host: 9 days 3 h, limit 30 at 2026-"));
  late.evidence.value = 45.25;
  EXPECT_THAT(sentence_of(late, 1), HasSubstr("host: 45.2 s, limit 30 at 2026-"));
}

TEST(AlertWords, SayInShortWhatAnAlertIsAbout) {
  EXPECT_EQ(words_of("data.outdated:leap_seconds"), "the table of leap seconds is old");
  EXPECT_EQ(words_of("channel.silent:sun2"), "nothing from sun2");
  EXPECT_EQ(words_of("spin.nutation"), "half-angle of the nutation");
  EXPECT_EQ(words_of("link.restarted:gs1"),
            "sessions that the source began in the last minute (gs1)");
  EXPECT_EQ(words_of("none.such"), "none.such");
}

TEST(AlertWords, NameTheServiceThatRunsBesideThisOne) {
  auto twice = change(AlertCode::ServiceTwice, Change::Raised, 0.0);
  twice.who = "spindrift gs2:4242";
  EXPECT_EQ(sentence_of(twice),
            "another service publishes results of the spacecraft in this partition (spindrift "
            "gs2:4242) at 2026-11-20T03:00:00.000Z: stop one of the two; `spindrift doctor` says "
            "who is on the bus");
}

TEST(AlertWords, NameTheThingWhoseValueTheyGive) {
  auto silent = change(AlertCode::ChannelSilent, Change::Raised, 5.0);
  silent.about = "sun";
  silent.evidence.value = 5.0;
  silent.evidence.unit = "s";
  EXPECT_EQ(sentence_of(silent),
            "nothing from sun for 5 s, limit 5 at 2026-11-20T03:00:00.000Z: look at sensor and "
            "telemetry link");
  auto lies = change(AlertCode::SensorContradicts, Change::Raised, 5.0);
  lies.about = "star";
  EXPECT_THAT(sentence_of(lies), StartsWith("a sensor contradicts others beyond what the mission "
                                            "file allows (star): 1.25 deg, limit 5 at "));
  lies.about = "unknown";
  lies.who = "star, magnetometer";
  EXPECT_EQ(sentence_of(lies),
            "two sensors contradict each other beyond what the mission file allows, and nothing "
            "tells which is wrong (star, magnetometer): 1.25 deg, limit 5 at "
            "2026-11-20T03:00:00.000Z: check mounting, signs, units and time tags of both in the "
            "mission file");
  EXPECT_EQ(words_of("sensor.contradicts:unknown"),
            "two sensors contradict each other beyond what the mission file allows, and nothing "
            "tells which is wrong");
}

TEST(AlertWords, SayNothingOfTheValueOfAMerePresence) {
  auto lost = change(AlertCode::AttitudeLost, Change::Raised, 1.0);
  lost.evidence.is_presence = true;
  EXPECT_THAT(sentence_of(lost), StartsWith("the answer in force is LOST at "));
}

TEST(AlertWords, NameTheGateThatSaysThatTheAttitudeIsLost) {
  auto lost = change(AlertCode::AttitudeLost, Change::Raised, 5.0);
  lost.evidence.value = 10.25;
  lost.evidence.more = {{"gate", "lost"}, {"hits", std::int64_t{9}}, {"window", std::int64_t{10}}};
  EXPECT_EQ(sentence_of(lost),
            "the lost gate is open: the measured field is away from that of the commanded "
            "attitude: 10.2 deg, limit 5 in 9 of 10 samples at 2026-11-20T03:00:00.000Z: stop "
            "control until the attitude is found again");
}

TEST(AlertWords, SayWhatEndsAndWhen) {
  auto outdated = change(AlertCode::DataOutdated, Change::Raised, 24.0);
  outdated.about = "orbit";
  EXPECT_EQ(sentence_of(outdated),
            "what the service needs ends: the orbit ends in 1 h 15 min at "
            "2026-11-20T03:00:00.000Z: get the next ephemeris");
  outdated.about = "leap_seconds";
  outdated.evidence.value = -3630.0;
  EXPECT_EQ(sentence_of(outdated),
            "what the service needs ends: the table of leap seconds ended 151 days 6 h ago at "
            "2026-11-20T03:00:00.000Z: install a newer tzdata");
  outdated.about = "field_coefficients";
  EXPECT_EQ(sentence_of(outdated),
            "what the service needs ends: the model of the Earth's field ended 151 days 6 h ago at "
            "2026-11-20T03:00:00.000Z: install a program with the next generation of it");
}

TEST(AlertWords, GiveEvidenceToPrograms) {
  const auto evidence = nlohmann::json::parse(
      evidence_json(change(AlertCode::SpinSigma, Change::Raised, 1.0).evidence, "00ff"));
  EXPECT_EQ(evidence["value"], 1.25);
  EXPECT_EQ(evidence["limit"], 1.0);
  EXPECT_EQ(evidence["since_tai_ns"], 1'795'143'637'000'000'000);
  EXPECT_EQ(evidence["config_sha256"], "00ff");
}

TEST(AlertWords, GiveWhatElseIsKnownByItsName) {
  Evidence evidence = change(AlertCode::SensorContradicts, Change::Raised, 5.0).evidence;
  evidence.more = {{"angle_deg", 2.0}, {"with", std::vector<std::string>{"sun", "star"}}};
  const auto json = nlohmann::json::parse(evidence_json(evidence, "00ff"));
  EXPECT_EQ(json["angle_deg"], 2.0);
  EXPECT_EQ(json["with"], (std::vector<std::string>{"sun", "star"}));
}

TEST(AlertWords, AreDocumentedWithTheirKeysAndSeverities) {
  std::istringstream lines{text_of(source_folder() / "schemas/alerts.md")};
  std::map<std::string, std::string> severities;
  const std::regex row{R"(\| `([a-z_.]+)(:[A-Z]+)?` \| ([^|]+) \|.*)"};
  std::smatch cells;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, cells, row)) {
      severities[cells[1]] += cells[3];
    }
  }
  EXPECT_EQ(severities.size(), static_cast<std::size_t>(kAlertCodes));
  for (int i = 0; i < kAlertCodes; ++i) {
    const auto code = static_cast<AlertCode>(i);
    EXPECT_THAT(severities[std::string{name_of(code)}],
                HasSubstr(std::string{name_of(severity_of(code))}))
        << name_of(code);
  }
}

}  // namespace spindrift::alert_words_test
