#include "services/simulation/dispersions.h"

#include <cmath>
#include <string>
#include <variant>

#include "services/mission/values.h"
#include "services/simulation/scenario.h"
#include "tests/support/matchers.h"
#include "tests/support/scenario_text.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing::dispersions_test {

const std::string kDispersed = text_of(scenarios() / "tumbling.toml") + R"(
[[dispersions]]
key = "attitude.rate_deg_s"
sigma = 0.1
[[dispersions]]
key = "truth.inertia.factor"
range = 0.2
)";

TomlDocument document(const std::string& text = kDispersed) {
  const TemporaryFolder folder;
  return read_scenario(folder.write("scenario.toml", text)).value();
}

std::vector<double> rates_of(const TomlDocument& from) {
  return value_of<std::vector<double>>(from.values, "attitude.rate_deg_s");
}

TEST(Dispersions, AreDrawnByTheSeedOfTheRunAlone) {
  const TomlDocument base = document();
  const TomlDocument third = dispersed(base, 3).value();
  EXPECT_EQ(value_of<std::int64_t>(third.values, "pass.seed"), 8);
  EXPECT_EQ(rates_of(third), rates_of(dispersed(document(), 3).value()));
  EXPECT_NE(rates_of(third), rates_of(dispersed(base, 4).value()));
  // Run 3 of seed 5 is run 0 of seed 8.
  EXPECT_EQ(rates_of(third),
            rates_of(dispersed(document(replaced(kDispersed, "seed = 5", "seed = 8")), 0).value()));
  EXPECT_NE(rates_of(base), rates_of(third));
}

TEST(Dispersions, HaveTheSpreadThatIsAsked) {
  constexpr int kRuns = 500;
  const TomlDocument base = document();
  const std::vector<double> nominal = rates_of(base);
  double squares = 0.0;
  double farthest = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const TomlDocument own = dispersed(base, run).value();
    ASSERT_TRUE(own.problems.empty());
    for (std::size_t i = 0; i < 3; ++i) {
      squares += std::pow((rates_of(own)[i] - nominal[i]) / 0.1, 2);
    }
    farthest = std::max(farthest, std::abs(number(own.values, "truth.inertia.factor") - 1.0));
  }
  // Five standard deviations of chi-square with 1500 degrees of freedom.
  EXPECT_NEAR(squares, 3.0 * kRuns, 5.0 * std::sqrt(2.0 * 3.0 * kRuns));
  EXPECT_LT(farthest, 0.2);
  EXPECT_GT(farthest, 0.19);
}

TEST(Dispersions, DoNotChangeTheScenarioAsItStands) {
  const auto alone = loaded(text_of(scenarios() / "tumbling.toml"));
  const auto with = loaded(kDispersed);
  EXPECT_EQ(std::get<TumblingScenario>(with.flight).truth.body.at_start.rate_body_rad_s,
            std::get<TumblingScenario>(alone.flight).truth.body.at_start.rate_body_rad_s);
  EXPECT_EQ(with.mission_toml, alone.mission_toml);
}

TEST(Dispersions, OfWhatHoldsNoNumberAreRefused) {
  EXPECT_THAT(error_of(replaced(kDispersed, "truth.inertia.factor", "spacecraft.id")),
              HasSubstr("dispersions[1].key = \"spacecraft.id\": must be a key of this scenario"));
  EXPECT_THAT(error_of(replaced(kDispersed, "truth.inertia.factor", "truth.inertia.factr")),
              HasSubstr("dispersions[1].key = \"truth.inertia.factr\": must be a key"));
  EXPECT_THAT(error_of(replaced(kDispersed, "truth.inertia.factor", "three_axis.inertia.kg_m2")),
              HasSubstr("that is no inertia and no quaternion"));
  EXPECT_THAT(error_of(replaced(kDispersed, "range = 0.2", "range = 0.2\nsigma = 0.1")),
              HasSubstr("dispersions[1]"));
  EXPECT_THAT(
      error_of(replaced(kDispersed, "range = 0.2", "range = -0.2")),
      HasSubstr("dispersions[1].range = -0.20000000000000001: must lie in (0, 1000000000]"));
}

TEST(Dispersions, ThatLeadOutOfTheirRangeAreSaid) {
  const TomlDocument base = document(replaced(kDispersed, "range = 0.2", "range = 1000"));
  int bad = 0;
  for (int run = 0; run < 10; ++run) {
    if (const auto scenario = scenario_of(dispersed(base, run).value()); !scenario) {
      EXPECT_THAT(scenario.error().message,
                  AllOf(HasSubstr("truth.inertia.factor = "), HasSubstr("must lie in [0.01, 100]"),
                        Not(HasSubstr("must be a key"))));
      ++bad;
    }
  }
  EXPECT_GT(bad, 5);
}

}  // namespace spindrift::testing::dispersions_test
