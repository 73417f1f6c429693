#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/exact_mission.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"
#include "tests/support/test_paths.h"
#include "tests/support/well_formed.h"

namespace spindrift::geometry_test {

const std::filesystem::path kMissions = test_data() / "mission";
const std::string kNominal = (recorded_passes() / "nominal" / "mission.toml").string();

/// Returns the arguments of the nominal pass with these options replaced or added.
std::vector<std::string> arguments_with(
    const std::vector<std::pair<std::string, std::string>>& changes,
    const std::string& mission = kNominal) {
  std::vector<std::pair<std::string, std::string>> options = {{"--mission", mission},
                                                              {"--from", "2026-11-20T03:00:00Z"},
                                                              {"--to", "2026-11-20T03:10:00Z"},
                                                              {"--attitude", "100,-55"}};
  for (const auto& change : changes) {
    const auto known = std::find_if(options.begin(), options.end(), [&](const auto& option) {
      return option.first == change.first;
    });
    if (known != options.end()) {
      *known = change;
    } else {
      options.push_back(change);
    }
  }
  std::vector<std::string> arguments = {"geometry"};
  for (const auto& [name, value] : options) {
    // Option and value are one word, since a value may begin with a minus.
    arguments.push_back(name);
    arguments.back().append(value.empty() ? "" : "=").append(value);
  }
  return arguments;
}

nlohmann::json planned(const std::vector<std::string>& arguments) {
  const Ran program = succeeded(arguments);
  EXPECT_EQ(program.log, "");
  return program.json();
}

TEST(Geometry, PrintsATableAndWhatHolds) {
  const Ran program = succeeded(arguments_with({}));
  EXPECT_EQ(program.log, "");
  const auto lines = lines_of(program.out);
  ASSERT_GT(lines.size(), 63U);
  EXPECT_EQ(lines[0],
            "SPINNER  2026-11-20T03:00:00Z to 2026-11-20T03:10:00Z, axis RA 100.0000 Dec -55.0000 "
            "deg, 60 rpm (assumed, see --rpm)");
  EXPECT_THAT(lines[1], AllOf(StartsWith("UTC"), HasSubstr("Delta N"), HasSubstr("case")));
  EXPECT_THAT(lines[2], StartsWith("2026-11-20T03:00:00Z     0.0   13915"));
  EXPECT_THAT(lines[62], AllOf(StartsWith("2026-11-20T03:10:00Z    10.0"), HasSubstr("12NnSs")));
  EXPECT_THAT(program.out, HasSubstr("all the time"));
  EXPECT_THAT(program.out, HasSubstr("  fix by case 1: one axis\n"));
  for (std::size_t i = 3; i <= 62; ++i) {
    EXPECT_EQ(lines[i].size(), lines[2].size()) << lines[i];
  }
}

TEST(Geometry, GivesOneObject) {
  const auto plan = planned(arguments_with({{"--rpm", "30"}, {"--step", "120"}, {"--json", ""}}));
  EXPECT_EQ(plan["spacecraft"], "SPINNER");
  EXPECT_NEAR(plan["ra_deg"], 100.0, 1e-9);
  EXPECT_NEAR(plan["dec_deg"], -55.0, 1e-9);
  EXPECT_NEAR(plan["rate_rpm"], 30.0, 1e-9);
  EXPECT_EQ(plan["rate_assumed"], false);
  EXPECT_EQ(plan["from_utc"], "2026-11-20T03:00:00.000Z");
  EXPECT_EQ(plan["to_utc"], "2026-11-20T03:10:00.000Z");
  EXPECT_EQ(plan["step_s"], 120.0);
  EXPECT_TRUE(plan["plot"].is_null());
  ASSERT_EQ(plan["steps"].size(), 6U);
  const auto& last = plan["steps"].back();
  for (const char* const key :
       {"t_tai_ns", "utc", "minutes", "range_km", "sun_angle_deg", "earth_angle_deg",
        "dihedral_deg", "sun_earth_deg", "disc_deg", "sun_hidden", "in_line", "north", "south",
        "edges", "geometry_case", "axes", "told_apart", "fix_sigma_deg", "sigma_deg"}) {
    EXPECT_TRUE(last.contains(key)) << key;
  }
  EXPECT_EQ(last["north"]["view"], "crosses");
  EXPECT_EQ(last["north"]["delta_class"], "usable");
  EXPECT_EQ(last["edges"]["south_out"], "seen");
  EXPECT_TRUE(plan["steps"][0]["sigma_deg"].is_null());
  ASSERT_FALSE(plan["events"].empty());
  EXPECT_EQ(plan["events"][0]["from_utc"], plan["from_utc"]);
}

TEST(Geometry, NoiseInAngleGoesWithTheRate) {
  const PassCopy exact{"nominal"};
  exact.append(kExactSpin);
  const auto fix_sigma_deg = [&](const char* rpm) {
    return planned(arguments_with({{"--rpm", rpm}, {"--step", "600"}, {"--json", ""}},
                                  exact.mission().string()))["steps"][0]["fix_sigma_deg"]
        .get<double>();
  };
  // The Earth direction moves slightly less in a shorter turn, so the ratio is not exactly 2.
  EXPECT_NEAR(fix_sigma_deg("100") / fix_sigma_deg("50"), 2.0, 0.01);
}

TEST(Geometry, DrawsAPlot) {
  const TemporaryFolder folder;
  const PassCopy copy{"nominal"};
  copy.replace("SPINNER", "<A & B>");
  const auto plot = folder.path() / "pass.svg";
  const Ran program = succeeded(arguments_with({{"--plot", plot}}, copy.mission().string()));
  const std::string svg = text_of(plot);
  EXPECT_EQ(testing::xml_problem(svg), "");
  EXPECT_THAT(svg,
              AllOf(StartsWith("<svg "), HasSubstr("&lt;A &amp; B&gt;: geometry of the pass")));
  for (const char* const part : {"sun angle", "Chord across the Earth", "|Delta|",
                                 "all edges so far", "north beam", "case 1", "2026-11-20 UTC"}) {
    EXPECT_THAT(svg, HasSubstr(part));
  }
  EXPECT_THAT(program.out, HasSubstr("plot: " + plot.string()));
}

struct Refusal {
  std::vector<std::pair<std::string, std::string>> changes;
  std::string says;
};

TEST(Geometry, RefusesWhatCannotBe) {
  const std::vector<Refusal> refusals = {
      {{{"--attitude", "100,-91"}}, "--attitude 100,-91: DEC must lie in [-90, 90] deg"},
      {{{"--attitude", "400,0"}}, "--attitude 400,0: RA must lie in [-360, 360] deg"},
      {{{"--attitude", "nan,0"}}, "RA must lie in"},
      {{{"--attitude", "100 -55"}}, "--attitude 100 -55: must read RA,DEC in deg"},
      {{{"--attitude", "100,"}}, "must read RA,DEC in deg"},
      {{{"--from", "2026-11-20T03:10:00Z"}},
       "--from 2026-11-20T03:10:00Z must lie before --to 2026-11-20T03:10:00Z"},
      {{{"--from", "2026-11-20T03:00:00"}}, "must be UTC and end in Z"},
      {{{"--to", "tomorrow"}}, "--to: time 'tomorrow': must read YYYY-MM-DD"},
      {{{"--to", "2026-12-31T00:00:00Z"}}, "at most 7"},
      {{{"--rpm", "0"}}, "--rpm 0: must lie in [5, 200]"},
      {{{"--step", "0"}}, "--step 0: must be above 0 s"},
      {{{"--step", "nan"}}, "--step nan: must be above 0 s"},
      {{{"--step", "0.001"}}, "at most 10000"},
      {{{"--to", "2026-11-20T03:20:00Z"}}, "480 s after the ephemeris ends"},
      {{{"--mission", "/nowhere.toml"}}, "/nowhere.toml"},
      {{{"--mission", kMissions / "dawn-2015.toml"}},
       R"(dawn-2015.toml:3: spacecraft.kind = "three_axis": must be "spin")"},
      {{{"--plot", "/nowhere/pass.svg"}}, "/nowhere/pass.svg"},
      {{{"--plot", "pass.png"}}, "--plot: 'pass.png': must end in .svg: plots are written as SVG"},
      {{{"--plot", "pass"}}, "--plot: 'pass': must end in .svg"}};
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.says);
    auto changes = refusal.changes;
    changes.emplace_back("--json", "");
    const Ran program = refused(arguments_with(changes), {refusal.says});
    EXPECT_THAT(program.json()["error"].get<std::string>(), HasSubstr(refusal.says));
  }
}

TEST(Geometry, NamesAllThatIsWrongAtOnce) {
  const Ran program =
      refused(arguments_with({{"--attitude", "0,91"}, {"--rpm", "500"}, {"--to", "x"}}), {});
  EXPECT_THAT(program.log,
              AllOf(HasSubstr("DEC must"), HasSubstr("--rpm 500"), HasSubstr("--to: time 'x'")));
  EXPECT_THAT(program.out, IsEmpty());
}

/// Expects the planned sigma of a ten-minute pass that starts at 03:00 to be the published one.
void expect_sigma_foretold(const std::filesystem::path& folder) {
  const auto truth = nlohmann::json::parse(text_of(folder / "truth.json"));
  const auto text = [&](const char* key) { return std::to_string(truth[key].get<double>()); };
  const auto plan = planned(arguments_with({{"--attitude", text("ra_deg") + "," + text("dec_deg")},
                                            {"--rpm", text("rpm")},
                                            {"--json", ""}},
                                           (folder / "mission.toml").string()));
  const double planned_deg = plan["steps"].back()["sigma_deg"];
  const double published_deg = Processed{folder}.run["sequential"]["sigma_deg"];
  EXPECT_NEAR(published_deg / planned_deg, 1.0, 0.2);
}

TEST(Geometry, ForetellsTheSigmaThatASimulatedPassGives) {
  expect_sigma_foretold(Simulated{"gto-nominal.toml"}.pass);
}

TEST(Geometry, ForetellsTheSigmaOfOneBeamWhereTheMissionHasOne) {
  PassCopy copy{"north-only"};
  std::string mission = text_of(copy.mission());
  const auto south = mission.find("[spin.ir.south]");
  mission.erase(south, mission.find("[spin.noise]") - south);
  std::ofstream{copy.mission()} << mission;
  std::filesystem::copy(kPasses / "north-only" / "truth.json", copy.folder.path());
  expect_sigma_foretold(copy.folder.path());
}

}  // namespace spindrift::geometry_test
