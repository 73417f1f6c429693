#include "services/simulation/comparison_report.h"
#include "tests/support/matchers.h"
#include "tests/support/well_formed.h"

namespace spindrift::comparison_plot_test {

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);

struct Compared {
  ComparisonReport report;
  std::vector<ComparedSample> samples;
};

/// Returns a comparison in which the gyro leaves its band after 100 s and the sun sensor sends
/// nothing.
Compared compared() {
  DepartureWatch watch{{{.name = "gyro", .unit = "", .holding_s = 10.0},
                        {.name = "gyro_x", .unit = "deg/s", .holding_s = 10.0},
                        {.name = "sun", .unit = "", .holding_s = 10.0},
                        {.name = "sun_x", .unit = "deg", .holding_s = 10.0}},
                       5.0};
  Compared all;
  for (int t_s = 0; t_s < 200; ++t_s) {
    const TaiTime t = shifted(kStart, t_s);
    const double residual = t_s < 100 ? 0.001 : 0.02;
    all.samples.push_back({.channel = 0, .t = t, .came = true});
    all.samples.push_back(
        {.channel = 1,
         .t = t,
         .came = true,
         .value = ComparedValue{.flight = 1.0 + residual, .model = 1.0, .sigma = 0.002}});
    all.samples.push_back({.channel = 2, .t = t, .came = false});
  }
  for (const ComparedSample& sample : all.samples) {
    watch.evaluate(sample);
  }
  all.report = {.spacecraft_id = "SAT<1>",
                .model = "pass/scenario.toml",
                .span = {.from = kStart, .to = shifted(kStart, 200.0)},
                .band_sigmas = 5.0,
                .channels = watch.channels()};
  return all;
}

TEST(ComparisonPlot, ShowsFlightModelResidualsAndDepartures) {
  const auto [report, samples] = compared();
  const std::string page = plot_of(report, samples);
  EXPECT_EQ(testing::xml_problem(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("gyro_x, deg/s: flight, and the model"),
                          HasSubstr("gyro_x: flight minus model, in sigma"), HasSubstr(">band<"),
                          HasSubstr("model: scenario.toml"), Not(HasSubstr("nan"))));
}

TEST(ComparisonPlot, ShowsAPassOfOneSample) {
  auto [report, samples] = compared();
  samples.resize(2);
  EXPECT_EQ(testing::xml_problem(plot_of(report, samples)), "");
}

TEST(ComparisonText, NamesWhatDeparts) {
  EXPECT_THAT(to_text(compared().report),
              AllOf(HasSubstr("gyro_x               200       0.0105"),
                    HasSubstr("gyro_x          away since 2026-03-01T04:01:40.000Z: 0.02 deg/s, "
                              "band 0.01\n"),
                    HasSubstr("sun             silent since 2026-03-01T04:00:00.000Z"),
                    Not(HasSubstr("sun_x"))));
}

TEST(ComparisonText, GivesTheSameToPrograms) {
  const nlohmann::json json = to_json(compared().report);
  EXPECT_EQ(json["first_departure"], "sun");
  EXPECT_EQ(json["channels"].size(), 4U);
  const auto& gyro = json["channels"][1];
  EXPECT_EQ(gyro["departure"]["since_tai_ns"], tai_ns(shifted(kStart, 100.0)));
  EXPECT_EQ(gyro["departure"]["unit"], "deg/s");
  EXPECT_EQ(gyro["outside"], 100);
  EXPECT_TRUE(json["channels"][3]["rms"].is_null());
}

}  // namespace spindrift::comparison_plot_test
