#include "services/program/status_line.h"

#include "pipelines/time/utc.h"
#include "tests/support/matchers.h"
#include "tests/support/recorded_files.h"

namespace spindrift::status_line_test {

constexpr std::size_t kUsual = 80;

class StatusLine : public ::testing::Test {
 protected:
  std::string line(std::size_t columns, std::optional<double> rate_hz = 6.0) const {
    return status_line(mission_, health_, arrivals_, rate_hz, columns);
  }

  const Mission mission_ = load_mission(kPasses / "nominal" / "mission.toml").value();
  const TaiTime t_ = parse_utc("2026-11-20T03:24:04.250Z").value();
  SpacecraftHealth health_{.spacecraft = "SPINNER",
                           .link = LinkState::Live,
                           .last_sample = t_,
                           .data_age_s = 0.25,
                           .verdict = {.estimator = "sequential",
                                       .quality = Quality::Ambiguous,
                                       .sigma_deg = 0.0418,
                                       .ra_deg = 100.1464,
                                       .dec_deg = -54.9244}};
  TalliedArrivals arrivals_{.samples = 3600,
                            .revolution = 597,
                            .last = {{"sun1", t_},
                                     {"sun2", shifted(t_, -12.0)},
                                     {"north_in", shifted(t_, -120.0)},
                                     {"south_in", shifted(t_, -36'000.0)},
                                     {"south_out", shifted(t_, 2.0)}}};
};

TEST_F(StatusLine, HasAllThatItKnowsWhereThereIsRoom) {
  EXPECT_EQ(line(200),
            "SPINNER 2026-11-20 03:24:04Z age 0.2s rev 597 6.0/s sun 0/12 N 2m/- S 10h/0 "
            "ra 100.146 dec -54.924 sequential AMBIGUOUS 0.042deg");
}

TEST_F(StatusLine, FitsAnUsualTerminal) {
  EXPECT_EQ(line(kUsual),
            "SPINNER 03:24:04Z age 0.2s rev 597 sun 0/12 N 2m/- S 10h/0 AMBIGUOUS 0.042deg");
  health_.verdict.estimator = "mean";
  health_.verdict.quality = Quality::Ok;
  arrivals_.last = {{"sun1", t_}};
  EXPECT_EQ(line(kUsual),
            "SPINNER 03:24:04Z age 0.2s rev 597 6.0/s sun 0/- N -/- S -/- mean OK 0.042deg");
}

TEST_F(StatusLine, GivesUpWhatIsNeededLeastFirstAndIsNeverTooLong) {
  for (std::size_t columns = 1; columns < 200; ++columns) {
    EXPECT_LE(line(columns).size(), columns);
  }
  EXPECT_EQ(line(45), "SPINNER 03:24:04Z age 0.2s AMBIGUOUS 0.042deg");
  EXPECT_EQ(line(37), "SPINNER age 0.2s AMBIGUOUS 0.042deg");
  EXPECT_EQ(line(10), "age 0.2s");
}

TEST_F(StatusLine, SaysThatNothingComesAndThatThereIsNoAnswer) {
  health_.link = LinkState::Stale;
  health_.data_age_s = 75.0;
  health_.verdict = {};
  EXPECT_THAT(line(kUsual, std::nullopt), HasSubstr(" SILENT 75s rev 597 sun 75/87 "));
  EXPECT_THAT(line(kUsual), EndsWith(" no answer"));
  EXPECT_EQ(status_line(mission_, {.spacecraft = "SPINNER", .link = LinkState::Waiting}, {},
                        std::nullopt, kUsual),
            "SPINNER waiting for telemetry");
}

TEST_F(StatusLine, SaysOfWhenTheAnswerOfTheRunBeforeIs) {
  health_.data_age_s.reset();
  EXPECT_EQ(line(200, std::nullopt),
            "SPINNER waiting for telemetry last 2026-11-20T03:24:04Z ra 100.146 dec -54.924 "
            "sequential AMBIGUOUS 0.042deg");
}

TEST_F(StatusLine, ShowsTheSensorsThatTheMissionHas) {
  arrivals_.last.clear();
  EXPECT_THAT(line(kUsual), HasSubstr(" sun -/- N -/- S -/- "));
  Mission without = mission_;
  std::get<SpinConfig>(without.config).south.reset();
  EXPECT_THAT(status_line(without, health_, arrivals_, std::nullopt, kUsual),
              Not(HasSubstr(" S ")));
}

TEST(StatusLineOfThreeAxes, ShowsTheSensorsThatHaveCome) {
  const TaiTime t = parse_utc("2026-11-20T03:24:04.250Z").value();
  const auto mission = load_mission(test_data() / "three-axis/separation/mission.toml").value();
  const SpacecraftHealth health{
      .spacecraft = "SAT", .link = LinkState::Live, .last_sample = t, .data_age_s = 0.0};
  const TalliedArrivals arrivals{
      .samples = 10, .revolution = {}, .last = {{"gyro", t}, {"magnetometer", shifted(t, -3.0)}}};
  EXPECT_THAT(status_line(mission, health, arrivals, 21.0, kUsual),
              StartsWith("SAT 2026-11-20 03:24:04Z age 0.0s 21.0/s gyro 0 mag 3 no answer"));
}

}  // namespace spindrift::status_line_test
