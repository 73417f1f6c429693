#include "services/base/assessment_words.h"

#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::assessment_words_test {

using enum ReasonCode;

TEST(AssessmentWords, BeginWithTheQualityAndGiveTheReasonsInOrder) {
  EXPECT_EQ(sentence_of({Quality::Ok,
                         {{Revolutions, {{"count", std::int64_t{600}}}},
                          {EdgesGated, {{"count", std::int64_t{2}}}},
                          Reason{PoorLeverage, {}}}}),
            "OK, 600 revolutions, 2 edges gated, poor leverage");
  EXPECT_EQ(sentence_of({Quality::Doubtful,
                         {{Fixes, {{"count", std::int64_t{1}}}},
                          {FewFixes, {{"needed", std::int64_t{3}}}}}}),
            "DOUBTFUL, 1 fix, fewer than 3");
  EXPECT_EQ(sentence_of({Quality::Lost, {Reason{AwaitingFix, {}}}}), "LOST, awaiting a fix");
  EXPECT_EQ(
      sentence_of({Quality::Ambiguous, {{OtherAxis, {{"ra_deg", 181.504}, {"dec_deg", -53.176}}}}}),
      "AMBIGUOUS, or ra 181.50 dec -53.18 deg");
}

TEST(AssessmentWords, NameTheWrongSensor) {
  EXPECT_EQ(sentence_of({Quality::Doubtful,
                         {{Contradicted,
                           {{"sensor", "star"},
                            {"with", "sun, magnetometer"},
                            {"angle_deg", 2.0},
                            {"sigmas", 12.3},
                            {"since_tai_ns", std::int64_t{1'795'143'637'000'000'000}}}}}}),
            "DOUBTFUL, star wrong");
}

TEST(AssessmentWords, CallNoSensorWrongWhereNothingTellsWhich) {
  EXPECT_EQ(sentence_of({Quality::Doubtful, {{Contradicted, {{"sensor", "unknown"}}}}}),
            "DOUBTFUL, sensors differ");
}

TEST(AssessmentWords, CountOneOfAThing) {
  const auto one_of = [](ReasonCode code) { return Reason{code, {{"count", std::int64_t{1}}}}; };
  EXPECT_EQ(sentence_of({Quality::Doubtful,
                         {one_of(StarFixes),
                          one_of(SunVectors),
                          one_of(StarFixesGated),
                          {GyroGaps, {{"count", std::int64_t{1}}, {"longest_s", 12.0}}},
                          one_of(GyroSaturated),
                          one_of(GyroOutliers),
                          one_of(Edges)}}),
            "DOUBTFUL, 1 star fix, 1 sun vector, 1 star fix gated, 1 gyro gap, up to 12.0 s, 1 "
            "gyro sample saturated, 1 gyro outlier, 1 edge");
  EXPECT_EQ(sentence_of({Quality::Ok, {{StarFixes, {{"count", std::int64_t{2}}}}}}),
            "OK, 2 star fixes");
}

TEST(AssessmentWords, ShowTimesAsUtcAndBiasesWithTheirUnits) {
  EXPECT_EQ(
      sentence_of(
          {Quality::Converging,
           {{Since, {{"since_tai_ns", std::int64_t{1'795'143'637'000'000'000}}}},
            {Bias, {{"bias", "north_chord"}, {"value", 0.1}, {"sigma", 0.02}, {"unit", "deg"}}}}}),
      "CONVERGING, since 2026-11-20T03:00:00Z, north_chord +0.100 +/- 0.020 deg");
}

TEST(AssessmentWords, ShowValuesToTheDigitsOfTheirSigma) {
  EXPECT_EQ(
      sentence_of(
          {Quality::Ok,
           {{Bias,
             {{"bias", "north_chord"}, {"value", -0.00031}, {"sigma", 4.2e-5}, {"unit", "deg"}}},
            {Coning, {{"deg", 0.00123}, {"sigma_deg", 2.1e-4}}},
            {OtherAxis, {{"ra_deg", 181.504}, {"dec_deg", -53.176}, {"sigma_deg", 2.3}}},
            {Nutation, {{"deg", 0.00042}, {"period_s", 2.5}}},
            {NoConing, {{"detectable_deg", 0.00037}}}}}),
      "OK, north_chord -0.000310 +/- 0.000042 deg, coning 0.00123 +/- 0.00021 deg, or ra 181.5 dec "
      "-53.2 deg, nutation 0.00042 deg, period 2.500 s, no coning above 0.00037 deg");
}

TEST(AssessmentWords, StandWithoutAValueThatADamagedArchiveLost) {
  EXPECT_EQ(sentence_of({Quality::Ok, {Reason{ModelOff, {}}}}),
            "OK, model off {deg:.2g} deg: {key}");
}

TEST(AssessmentWords, AreDocumentedWithTheirCodes) {
  const std::string documented = text_of(source_folder() / "schemas/status.md");
  for (int i = 0; i < kReasonCodes; ++i) {
    EXPECT_THAT(documented,
                HasSubstr("\n| `" + std::string{name_of(static_cast<ReasonCode>(i))} + "` |"));
  }
  for (int i = 0; i < kQualities; ++i) {
    EXPECT_THAT(documented,
                HasSubstr("\n| `" + std::string{name_of(static_cast<Quality>(i))} + "` |"));
  }
}

}  // namespace spindrift::assessment_words_test
