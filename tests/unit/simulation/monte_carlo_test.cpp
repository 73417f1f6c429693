#include "services/simulation/monte_carlo.h"

#include <filesystem>
#include <map>
#include <string>

#include "services/simulation/monte_carlo_text.h"
#include "services/simulation/statistics.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"
#include "tests/support/well_formed.h"

namespace spindrift::monte_carlo_test {

/// Returns a minute of the nominal spinner whose axis differs between runs.
std::filesystem::path short_scenario(const TemporaryFolder& folder) {
  std::string text = text_of(scenarios() / "gto-nominal.toml");
  const std::string whole = "duration_s = 600.0";
  text.replace(text.find(whole), whole.size(), "duration_s = 60.0\nseed = 40");
  return folder.write("scenario.toml",
                      text + "[[dispersions]]\nkey = \"attitude.ra_deg\"\nrange = 5\n");
}

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
    if (entry.is_regular_file()) {
      files[std::filesystem::relative(entry.path(), folder).string()] = text_of(entry.path());
    }
  }
  return files;
}

MonteCarloResult result_of(const std::filesystem::path& scenario, const std::filesystem::path& out,
                           std::int64_t runs, int jobs) {
  return value_or_throw(
      monte_carlo({.scenario = scenario, .out = out, .runs = runs, .jobs = jobs}));
}

TEST(MonteCarlo, GivesTheSameBytesHoweverManyRunAtOnce) {
  const TemporaryFolder folder;
  const auto scenario = short_scenario(folder);
  const MonteCarloResult one = result_of(scenario, folder.path() / "one", 4, 1);
  const MonteCarloResult three = result_of(scenario, folder.path() / "three", 4, 3);
  EXPECT_EQ(runs_csv(one), runs_csv(three));
  const auto files = files_in(folder.path() / "one");
  EXPECT_EQ(files.size(), 4U * 4U);
  EXPECT_EQ(files, files_in(folder.path() / "three"));
  EXPECT_NE(files.at("0000/pulses.csv"), files.at("0001/pulses.csv"));
  // A run does not depend on the number of runs.
  const MonteCarloResult two = result_of(scenario, folder.path() / "two", 2, 2);
  EXPECT_THAT(runs_csv(one), StartsWith(runs_csv(two)));
}

TEST(MonteCarlo, NamesTheRunThatCannotBe) {
  const TemporaryFolder folder;
  const auto scenario = folder.write("wild.toml", text_of(short_scenario(folder)) +
                                                      "[[dispersions]]\n"
                                                      "key = \"attitude.rate_rpm\"\n"
                                                      "range = 1000\n");
  const auto result =
      monte_carlo({.scenario = scenario, .out = folder.path() / "out", .runs = 20, .jobs = 2});
  EXPECT_THAT(result.error().message, AllOf(StartsWith("run "), HasSubstr("attitude.rate_rpm = ")));
}

TEST(MonteCarlo, RefusesAFolderThatIsNotEmpty) {
  const TemporaryFolder folder;
  const auto scenario = short_scenario(folder);
  const auto result =
      monte_carlo({.scenario = scenario, .out = folder.path(), .runs = 1, .jobs = 1});
  EXPECT_THAT(result.error().message, HasSubstr("must be an empty folder, or not be there"));
}

/// Returns a result with two measures, one of which is missing in a run.
MonteCarloResult made_result() {
  MonteCarloResult result{.spacecraft_id = "SPINNER", .runs = {}};
  for (int i = 0; i < 20; ++i) {
    result.runs.push_back(
        {.run = i,
         .seed = 7 + i,
         .measures = {{.name = "error_deg", .value = 20.0 - i},
                      {.name = "settled_s", .value = i == 0 ? std::nullopt : std::optional{5.0}}}});
  }
  return result;
}

TEST(Statistics, AreThoseOfTheRunsThatHaveAnAnswer) {
  const auto all = statistics_of(made_result());
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].count, 20);
  EXPECT_DOUBLE_EQ(all[0].spread->mean, 10.5);
  EXPECT_DOUBLE_EQ(all[0].spread->rms, std::sqrt(143.5));
  EXPECT_EQ(all[0].spread->least, 1.0);
  EXPECT_EQ(all[0].spread->median, 10.0);
  EXPECT_EQ(all[0].spread->most_of_95, 19.0);
  EXPECT_EQ(all[0].spread->most, 20.0);
  EXPECT_EQ(all[1].count, 19);
  EXPECT_EQ(all[1].spread->median, 5.0);
}

TEST(Statistics, AreShown) {
  const MonteCarloResult result = made_result();
  EXPECT_THAT(runs_csv(result), StartsWith("run,seed,error_deg,settled_s\n0,7,20,\n1,8,19,5\n"));
  EXPECT_THAT(statistics_text(result), HasSubstr("SPINNER: 20 runs"));
  const auto json = statistics_json(result);
  EXPECT_TRUE(json["runs"][0]["settled_s"].is_null());
  EXPECT_EQ(json["statistics"]["error_deg"]["most"], 20.0);
  const std::string page = histograms(result);
  EXPECT_EQ(testing::xml_problem(page), "");
  EXPECT_THAT(page, HasSubstr("settled_s"));
}

}  // namespace spindrift::monte_carlo_test
