#include "services/base/notice_words.h"

#include <set>
#include <string>
#include <string_view>

#include "pipelines/three_axis/products.h"
#include "tests/support/matchers.h"

namespace spindrift::notice_words_test {

using enum NoticeCode;

TEST(NoticeWords, ListChannelsAndShowTimesToTheMillisecond) {
  EXPECT_EQ(
      sentence_of({SilentChannels, {{"channels", std::vector<std::string>{"sun2", "north_in"}}}}),
      "no edge at all came from sun2, north_in");
  EXPECT_EQ(sentence_of({PriorContradicted,
                         {{"t_tai_ns", std::int64_t{1'795'143'637'000'000'000}},
                          {"prior_from", "mission"}}}),
            "2026-11-20T03:00:00.000Z: the edges contradict the prior of the mission: the axis is "
            "another one, the mean begins anew");
}

TEST(NoticeWords, SayWhichEdgesAnAmbiguousAxisLacks) {
  EXPECT_EQ(sentence_of({AmbiguousNoPrior, {{"geometry_case", std::int64_t{7}}}}),
            "the axis is ambiguous to the end, for want of good sun1 edges: a prior in the mission "
            "file, or an operator, would choose among the candidates");
  EXPECT_EQ(sentence_of({AmbiguousAgainstPrior,
                         {{"geometry_case", std::int64_t{1}}, {"prior_from", "mission"}}}),
            "the axis is ambiguous to the end: the edges contradict the prior of the mission");
}

TEST(NoticeWords, NameEachCodeByItself) {
  std::set<std::string_view> names;
  for (int i = 0; i < kNoticeCodes; ++i) {
    names.insert(name_of(static_cast<NoticeCode>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kNoticeCodes));
  EXPECT_EQ(name_of(LateEdges), "late_edges");
  EXPECT_EQ(name_of(MeanNeverBegan), "mean_never_began");
  EXPECT_EQ(name_of(AttitudeNeverBegan), "attitude_never_began");
}

TEST(NoticeWords, GiveTheirValuesAndThoseOfWhyThereIsNoFix) {
  const Notice notice{NoFix,
                      {{"revolution", std::int64_t{4}}},
                      WhyNoFix{NoFixCode::SunEarthInLine, {{"sun_earth_deg", 0.5}}}};
  EXPECT_EQ(values_of(notice), nlohmann::json({{"revolution", 4}, {"sun_earth_deg", 0.5}}));
  EXPECT_EQ(values_of({LateEdges}), nlohmann::json::object());
}

TEST(NoticeWords, SayWhatMostOfAKindAreLeftOutForAndWhatHelps) {
  EXPECT_EQ(sentence_of({MostLeftOut,
                         {{"sensor", std::string{"gyro"}},
                          {"percent", 99.7},
                          {"rejected_by", std::string{"saturated"}},
                          {"rate_deg_s", 57.3},
                          {"range_deg_s", 10.0}}}),
            "100 % of the gyro samples so far are left out as 'saturated': the last has 57.3 "
            "deg/s, and range_deg_s = 10; correct that, or send the rates in rad/s");
  using enum Rejection;
  for (const Rejection rejection :
       {Late, OutOfTime, Contradicted, Operator, NoSensor, NoOrbit, NoField, Saturated, Frozen,
        Outlier, Shadow, Unit, Innovation}) {
    const std::string rejected_by{name_of(rejection)};
    const std::string sentence = sentence_of({MostLeftOut,
                                              {{"sensor", std::string{"sun"}},
                                               {"percent", 95.0},
                                               {"rejected_by", rejected_by},
                                               {"rate_deg_s", 1.0},
                                               {"range_deg_s", 1.0},
                                               {"sigmas", 9.0},
                                               {"most_sigmas", 5.0}}});
    if (rejected_by != "operator") {
      EXPECT_EQ(sentence.find("look at rejected_sample"), std::string::npos) << sentence;
    }
    EXPECT_EQ(sentence.find('{'), std::string::npos) << sentence;
  }
}

TEST(NoticeWords, SayWhatIsNotFinite) {
  EXPECT_EQ(sentence_of({NotFinite, {{"table", "spin_fix"}, {"column", "sigma_deg"}}}),
            "results are withheld: sigma_deg of spin_fix is not a finite number. The samples are "
            "stored; look for a value in the mission file that no instrument has");
}

TEST(NoFixWords, GiveTheMeasuredValues) {
  EXPECT_EQ(sentence_of(WhyNoFix{
                NoFixCode::ConesApart,
                {{"sun_angle_deg", 10.0}, {"earth_angle_deg", 20.0}, {"sun_earth_deg", 40.00004}}}),
            "the cones of 10.0000 deg about the Sun and 20.0000 deg about the Earth do not meet, "
            "which stand 40.0000 deg apart");
  EXPECT_EQ(sentence_of(WhyNoFix{NoFixCode::SunEarthInLine, {{"sun_earth_deg", 2.9}}}),
            "Sun and Earth stand 2.900 deg apart: the axis needs between 3 and 177 deg");
}

}  // namespace spindrift::notice_words_test
