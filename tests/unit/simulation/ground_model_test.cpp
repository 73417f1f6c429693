#include "services/simulation/ground_model.h"

#include "services/simulation/simulated_pass.h"
#include "tests/support/departures.h"
#include "tests/support/matchers.h"
#include "tests/support/scenario_text.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing::ground_model_test {

Scenario of_seed(const char* name, int seed) {
  std::string text = text_of(scenarios() / name);
  const auto at = text.find("seed = ");
  if (at == std::string::npos) {
    text = replaced(text, "[pass]", "[pass]\nseed = " + std::to_string(seed));
  } else {
    text.replace(at, text.find('\n', at) - at, "seed = " + std::to_string(seed));
  }
  return loaded(text);
}

/// Compares the pass of a scenario with the model of another scenario or the same.
ByChannel compared(const Scenario& flight, const Scenario& model) {
  const SimulatedPass pass = simulated_pass(flight, Progress::Hidden).value();
  ModelComparison comparison{std::make_shared<const GroundModel>(ground_model_of(model).value()),
                             5.0};
  in_order_of_arrival(pass.telemetry,
                      [&](const auto& arrived) { comparison.compare(arrived.value); });
  comparison.finish();
  return by_channel(comparison.channels());
}

class OwnModel : public ::testing::TestWithParam<const char*> {};

/// The pass has faults: lost, displaced and spurious samples, silences, gaps.
TEST_P(OwnModel, IsNotLeftByAPassOfTheScenario) {
  for (int seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = of_seed(GetParam(), seed);
    EXPECT_THAT(departures_s(compared(scenario, scenario), scenario.start), IsEmpty())
        << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, OwnModel,
                         ::testing::Values("gto-nominal.toml", "gto-dirty.toml",
                                           "gto-nutating.toml", "separation.toml", "tumbling.toml",
                                           "upper-stage.toml"),
                         [](const auto& scenario) {
                           std::string name = scenario.param;
                           name.resize(name.find('.'));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// The body has a tenth more inertia about one axis than the model.
TEST(GroundModel, IsLeftByABodyOfOtherInertia) {
  const std::string text = text_of(scenarios() / "upper-stage.toml");
  const Scenario model = loaded(text);
  const Scenario flight = loaded(replaced(text, "[[0.6, 0.0, 0.0]", "[[0.66, 0.0, 0.0]"));
  const auto departed = departures_s(compared(flight, model), model.start);
  EXPECT_TRUE(departed.contains("star_x") && departed.contains("gyro_x"))
      << ::testing::PrintToString(departed);
}

TEST(GroundModel, IsRefusedForAnotherSpacecraft) {
  const Mission mission = mission_of("mission.toml",
                                     "[spacecraft]\nid = \"OTHER\"\nkind = \"three_axis\"\n"
                                     "[three_axis.star_tracker]\nq_body_sensor = [0, 0, 0, 1]\n"
                                     "noise_arcsec = 20\n")
                              .value();
  EXPECT_THAT(
      load_ground_model(scenarios() / "tumbling.toml", mission),
      IsRefused(ErrorCode::InvalidConfiguration,
                AllOf(HasSubstr("tumbling.toml: spacecraft.id = \"LOSTSAT\": must be \"OTHER\""),
                      HasSubstr("mission.toml"))));
}

TEST(GroundModel, IsRefusedWithoutNoise) {
  const TemporaryFolder folder;
  const auto path = folder.write("scenario.toml", text_of(scenarios() / "gto-nominal.toml") +
                                                      "\n[truth.noise]\nsun_pulse_s = 0.0\n");
  EXPECT_THAT(load_scenario(path).and_then(ground_model_of),
              IsRefused(ErrorCode::InvalidConfiguration, HasSubstr("noise")));
}

}  // namespace spindrift::testing::ground_model_test
