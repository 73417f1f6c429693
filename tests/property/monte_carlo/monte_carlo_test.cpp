#include "services/simulation/monte_carlo.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "pipelines/statistics/distributions.h"
#include "services/simulation/statistics.h"
#include "tests/support/exact_mission.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::monte_carlo_statistics_test {

constexpr std::int64_t kRuns = 100;

/// Runs a delivered scenario with random attitude and rate.
MonteCarloResult runs_of(const char* name) {
  const TemporaryFolder folder;
  const auto scenario =
      folder.write("scenario.toml", text_of(scenarios() / name) + std::string{kExactThreeAxis} + R"(
[[dispersions]]
key = "attitude.euler312_icrf_deg"
range = 180
[[dispersions]]
key = "attitude.rate_deg_s"
sigma = 0.1
)");
  auto result =
      monte_carlo({.scenario = scenario, .out = folder.path() / "out", .runs = kRuns, .jobs = 2});
  EXPECT_TRUE(result) << result.error().message;
  return *std::move(result);
}

/// Expects a sum over three directions in every run to be in its 95 % chi-square band.
void expect_chi_square(const MonteCarloResult& result, const std::string& measure) {
  const auto& measures = result.runs.front().measures;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (measures[i].name == measure) {
      const std::vector<double> squares = values_of(result, i);
      ASSERT_EQ(squares.size(), static_cast<std::size_t>(kRuns));
      const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
      EXPECT_GT(sum, chi_square_beyond(0.975, 3.0 * kRuns));
      EXPECT_LT(sum, chi_square_beyond(0.025, 3.0 * kRuns));
      return;
    }
  }
  FAIL() << measure;
}

TEST(MonteCarloStatistics, SeparationsAreAsFarOffAsTheReconstructionSays) {
  const MonteCarloResult result = runs_of("separation.toml");
  expect_chi_square(result, "batch_t1_normalised_square");
  expect_chi_square(result, "attitude_normalised_square");
}

TEST(MonteCarloStatistics, TumblingSatellitesAreAsFarOffAsTheFilterSays) {
  expect_chi_square(runs_of("tumbling.toml"), "attitude_normalised_square");
}

}  // namespace spindrift::monte_carlo_statistics_test
