#include "services/operator/parse_action.h"

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/test_paths.h"

namespace spindrift::parse_action_test {

using nlohmann::json;

/// A spinner with all its channels but no ground model, and a spacecraft without a magnetometer.
KnownSpacecraft known() {
  Mission spinner = load_mission(recorded_passes() / "nominal" / "mission.toml").value();
  Mission stable = load_mission(test_data() / "mission" / "separation.toml").value();
  spinner.spacecraft_id = "SPINNER";
  stable.spacecraft_id = "STABLE";
  return known_spacecraft({spinner, stable});
}
const KnownSpacecraft kKnown = known();
constexpr std::int64_t kFrom = 1'795'143'637'000'000'000;

json request(const json& more) {
  json request{{"spacecraft", "SPINNER"}, {"by", "shift"}};
  request.update(more);
  return request;
}

std::string why_not(const json& more) {
  const auto action = parse_action(request(more), kKnown);
  return action ? "it is one" : action.error().message;
}

TEST(ParseAction, TakesEachWithItsArguments) {
  const std::vector<json> all{
      {{"action", "exclude_channel"}, {"channel", "north_in"}},
      {{"action", "include_channel"}, {"channel", "sun1"}},
      {{"action", "exclude_segment"}, {"from_tai_ns", kFrom}, {"to_tai_ns", kFrom + 1}},
      {{"action", "choose_root"}, {"ra_deg", 10}, {"dec_deg", -20.5}},
      {{"action", "set_prior"}, {"ra_deg", 10.0}, {"dec_deg", -20.5}, {"sigma_deg", 2}},
      {{"action", "mark_manoeuvre"}, {"note", "burn 2"}},
      {{"action", "set_target"}, {"ra_deg", -10.0}, {"dec_deg", 90}, {"t_tai_ns", kFrom}}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto action = value_or_throw(parse_action(request(all[i]), kKnown));
    ASSERT_EQ(std::get<SpinAction>(action.does).index(), i);
    EXPECT_EQ(action.action, all[i].at("action"));
    EXPECT_EQ(action.by, "shift");
    EXPECT_LE(action.action_id.size(), 40U);
    EXPECT_NE(action.action_id, parse_action(request(all[i]), kKnown)->action_id);
    EXPECT_EQ(action.t.has_value(), all[i].contains("t_tai_ns") || all[i].contains("from_tai_ns"));
  }
}

TEST(ParseAction, OfThreeAxesKnowsSensors) {
  const json of_sensor{{"spacecraft", "STABLE"}, {"channel", "star"}};
  json excluded = of_sensor;
  excluded["action"] = "exclude_channel";
  const auto action = value_or_throw(parse_action(request(excluded), kKnown));
  EXPECT_EQ(std::get<ExcludeChannel<SampleKind>>(std::get<AttitudeAction>(action.does)).channel,
            SampleKind::Star);
  EXPECT_EQ(action.arguments, R"({"channel":"star"})");
  EXPECT_THAT(why_not({{"spacecraft", "STABLE"}, {"action", "mark_manoeuvre"}}),
              HasSubstr("must be one of exclude_channel, include_channel, exclude_segment"));
}

TEST(ParseAction, TakesLimitsOfAnAlertByTheirNameWithinTheirBounds) {
  for (const auto& [spacecraft, key, limit] :
       {std::tuple{"SPINNER", "spin.sigma", "deg"}, {"STABLE", "attitude.doubtful", "seconds"}}) {
    const auto action = value_or_throw(parse_action(request({{"spacecraft", spacecraft},
                                                             {"action", "set_limit"},
                                                             {"key", key},
                                                             {limit, 0.5},
                                                             {"hold_off_s", 120}}),
                                                    kKnown));
    const auto& set = std::get<SetLimit>(action.does);
    EXPECT_EQ(set.key, key);
    EXPECT_EQ(set.limits, (std::map<std::string, double>{{limit, 0.5}, {"hold_off_s", 120.0}}));
  }
  const auto refused = [](const json& more) {
    json said{{"action", "set_limit"}, {"key", "spin.sigma"}};
    said.update(more);
    return why_not(said);
  };
  EXPECT_THAT(refused({{"key", "spin.sigmas"}, {"deg", 1}}),
              HasSubstr("key: \"spin.sigmas\": must be one of link.silent, link.late"));
  EXPECT_EQ(refused({{"percent", 1}}),
            "set_limit: a limit of spin.sigma is missing; percent is not known here: key, "
            "after_s, deg, hold_off_s are");
  EXPECT_EQ(refused({{"deg", 181}}), "set_limit: deg: 181: must be a number, 0.0001 to 180");
  EXPECT_EQ(refused({{"deg", "wide"}}),
            "set_limit: deg: \"wide\": must be a number, 0.0001 to 180");
  EXPECT_EQ(why_not({{"action", "set_limit"}, {"spacecraft", "OTHER"}}),
            "spacecraft: 'OTHER': must be one of SPINNER, STABLE");
}

TEST(ParseAction, RefusesWhatTheMissionLacks) {
  const auto of_stable = [](json said) {
    said["spacecraft"] = "STABLE";
    return why_not(said);
  };
  for (const char* const action : {"exclude_channel", "include_channel"}) {
    EXPECT_EQ(of_stable({{"action", action}, {"channel", "magnetometer"}}),
              std::string{action} +
                  ": channel: \"magnetometer\": the mission of STABLE has none: must be one of "
                  "gyro, star, sun");
  }
  const json segment{
      {"action", "exclude_segment"}, {"from_tai_ns", kFrom}, {"to_tai_ns", kFrom + 1}};
  EXPECT_EQ(of_stable(segment), "it is one");
  json of_sensor = segment;
  of_sensor["channel"] = "magnetometer";
  EXPECT_THAT(of_stable(of_sensor), HasSubstr("must be one of gyro, star, sun"));
  const auto limit = [](const char* key, const char* name) {
    return json{{"action", "set_limit"}, {"key", key}, {name, 1.0}};
  };
  EXPECT_THAT(of_stable(limit("spin.sigma", "deg")),
              HasSubstr("set_limit: key: \"spin.sigma\": the mission of STABLE has none: must be "
                        "one of link.silent, link.late"));
  EXPECT_THAT(why_not(limit("attitude.doubtful", "seconds")), HasSubstr("must be one of link."));
  EXPECT_THAT(why_not(limit("reconstruction.launcher", "hold_off_s")), HasSubstr("has none"));
  EXPECT_EQ(of_stable(limit("reconstruction.launcher", "hold_off_s")), "it is one");
  EXPECT_EQ(why_not(limit("attitude.lost", "hold_off_s")), "it is one");
  EXPECT_THAT(why_not(limit("model.departure", "sigmas")), HasSubstr("has none"));
}

TEST(ParseAction, TakesASegmentAsOfItsBeginningOrOfATimeBeforeItsEnd) {
  const json segment{
      {"action", "exclude_segment"}, {"from_tai_ns", kFrom}, {"to_tai_ns", kFrom + 10}};
  EXPECT_EQ(parse_action(request(segment), kKnown)->t, tai_from_ns(kFrom));
  const auto with_t = [&](std::int64_t t_tai_ns) {
    json said = segment;
    said["t_tai_ns"] = t_tai_ns;
    return said;
  };
  EXPECT_EQ(parse_action(request(with_t(kFrom + 9)), kKnown)->t, tai_from_ns(kFrom + 9));
  EXPECT_EQ(why_not(with_t(kFrom + 10)),
            "exclude_segment: to_tai_ns: 1795143637000000010: must be later than t_tai_ns, "
            "1795143637000000010");
}

TEST(ParseAction, ReadsWhatItStores) {
  const json said{
      {"action", "set_prior"}, {"ra_deg", 0.1 + 0.2}, {"dec_deg", 1.0 / 3.0}, {"sigma_deg", 0.7}};
  const auto action = parse_action(request(said), kKnown).value();
  const auto again =
      what_it_does(SpacecraftKind::Spin, action.action, json::parse(action.arguments)).value();
  const auto prior_of = [](const ActionEffect& does) {
    return std::get<SetPrior>(std::get<SpinAction>(does)).prior;
  };
  EXPECT_EQ(prior_of(again).axis_icrf, prior_of(action.does).axis_icrf);
  EXPECT_EQ(prior_of(again).sigma_rad, 0.7 * kRadPerDeg);
}

TEST(ParseAction, SaysWhatIsWrongOfEveryAction) {
  const json good{{"action", "exclude_channel"}, {"channel", "north_in"}};
  const auto with = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return why_not(changed);
  };
  EXPECT_EQ(parse_action(json::array(), kKnown).error().message, "an action must be a JSON object");
  EXPECT_EQ(parse_action(json::object(), kKnown).error().message,
            "spacecraft is missing; by is missing; action is missing");
  EXPECT_EQ(with("spacecraft", "OTHER"), "spacecraft: 'OTHER': must be one of SPINNER, STABLE");
  EXPECT_EQ(with("by", ""), R"(by: "": must be text, not empty)");
  EXPECT_EQ(with("by", 7), "by: 7: must be text, not empty");
  EXPECT_THAT(with("by", "a\nb"), HasSubstr("none of them a control character"));
  EXPECT_THAT(with("by", std::string(201, 'x')), HasSubstr("must be at most 200 characters"));
  EXPECT_EQ(with("by", std::string(200, 'x')), "it is one");
  EXPECT_EQ(with("by", "Zoë"), "it is one");
  EXPECT_THAT(with("note", std::string(201, 'x')), HasSubstr("note: "));
  EXPECT_THAT(with("note", 7), HasSubstr("note: 7: must be text"));
  EXPECT_EQ(with("note", ""), "it is one");
  EXPECT_THAT(with("action", "stop"), HasSubstr("action: 'stop': must be one of exclude_channel"));
  EXPECT_THAT(with("t_tai_ns", "now"), HasSubstr("t_tai_ns: \"now\": must be nanoseconds of TAI"));
  EXPECT_THAT(with("t_tai_ns", 1.5e18), HasSubstr("t_tai_ns: 1.5e+18: must be"));
  EXPECT_THAT(with("t_tai_ns", 0), HasSubstr("t_tai_ns: 0: must be"));
  EXPECT_THAT(with("t_tai_ns", UINT64_MAX), HasSubstr("must be nanoseconds of TAI"));
  EXPECT_EQ(with("chanel", 1), "exclude_channel: chanel is not known here: channel are");
}

TEST(ParseAction, SaysWhatIsWrongOfArguments) {
  EXPECT_EQ(why_not({{"action", "exclude_channel"}}), "exclude_channel: channel is missing");
  EXPECT_EQ(why_not({{"action", "exclude_channel"}, {"channel", "gyro"}}),
            "exclude_channel: channel: \"gyro\": must be one of sun1, sun2, north_in, north_out, "
            "south_in, south_out");
  EXPECT_EQ(why_not({{"action", "exclude_segment"}, {"from_tai_ns", kFrom}, {"to_tai_ns", kFrom}}),
            "exclude_segment: to_tai_ns: 1795143637000000000: must be later than from_tai_ns");
  EXPECT_THAT(why_not({{"action", "exclude_segment"}}),
              AllOf(HasSubstr("from_tai_ns is missing"), HasSubstr("to_tai_ns is missing")));
  EXPECT_THAT(why_not({{"action", "exclude_segment"},
                       {"from_tai_ns", kFrom},
                       {"to_tai_ns", kFrom + 1},
                       {"channel", 1}}),
              HasSubstr("channel: 1: must be one of"));
  EXPECT_THAT(why_not({{"action", "choose_root"}, {"ra_deg", 361}, {"dec_deg", -91}}),
              AllOf(HasSubstr("ra_deg: 361: must be a number, -360 to 360"),
                    HasSubstr("dec_deg: -91: must be a number, -90 to 90")));
  EXPECT_THAT(why_not({{"action", "set_target"}, {"ra_deg", "x"}, {"dec_deg", nullptr}}),
              AllOf(HasSubstr("ra_deg: \"x\""), HasSubstr("dec_deg: null")));
  EXPECT_THAT(why_not({{"action", "set_prior"}, {"ra_deg", 1}, {"dec_deg", 1}, {"sigma_deg", 0}}),
              HasSubstr("sigma_deg: 0: must be a number, 0.001 to 180"));
  EXPECT_EQ(why_not({{"action", "mark_manoeuvre"}, {"ra_deg", 1}}),
            "mark_manoeuvre: ra_deg is not known here: nothing is asked for");
}

}  // namespace spindrift::parse_action_test
