#include "services/simulation/ground_model.h"

#include <fmt/format.h>

#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

Expected<void> check_spacecraft(const std::filesystem::path& path, const Scenario& scenario,
                                const Mission& mission) {
  const auto differs = [&](std::string_view key, std::string_view is, std::string_view must) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format(R"({}: spacecraft.{} = "{}": must be "{}", as in {})", shown(path.string()),
                     key, is, must, shown(mission.path.string()))}};
  };
  if (scenario.spacecraft_id != mission.spacecraft_id) {
    return differs("id", shown(scenario.spacecraft_id), shown(mission.spacecraft_id));
  }
  const auto kind = std::holds_alternative<SpinScenario>(scenario.flight)
                        ? SpacecraftKind::Spin
                        : SpacecraftKind::ThreeAxis;
  return kind == mission.kind() ? Expected<void>{}
                                : differs("kind", name_of(kind), name_of(mission.kind()));
}

}  // namespace

Expected<GroundModel> ground_model_of(const Scenario& scenario) {
  return std::visit(
             [&]<class Flight>(const Flight& flight) -> Expected<GroundModel> {
               if constexpr (std::is_same_v<Flight, SpinScenario>) {
                 return spin_model(flight.truth, flight.link, flight.telemetry.coded_resolution_s,
                                   scenario.orbit, scenario.duration_s);
               } else {
                 return three_axis_model(flight, scenario.orbit);
               }
             },
             scenario.flight)
      .map_error([](Error&& error) {
        return Error{ErrorCode::InvalidConfiguration, std::move(error.message)};
      });
}

Expected<std::shared_ptr<const GroundModel>> load_ground_model(const std::filesystem::path& path,
                                                               const Mission& mission) {
  return load_scenario(path).and_then([&](const Scenario& scenario) {
    return check_spacecraft(path, scenario, mission)
        .and_then([&] { return ground_model_of(scenario); })
        .map([](GroundModel&& model) {
          return std::make_shared<const GroundModel>(std::move(model));
        })
        .map_error([&](Error&& error) {
          const std::string file = shown(path.string());
          return error.message.starts_with(file)
                     ? std::move(error)
                     : Error{error.code, fmt::format("{}: {}", file, error.message)};
        });
  });
}

Expected<GroundModels> load_ground_models(std::span<const Mission> missions) {
  GroundModels models;
  std::string problems;
  for (const Mission& mission : missions) {
    if (!mission.ground_model) {
      continue;
    }
    if (auto model = load_ground_model(*mission.ground_model, mission)) {
      models.emplace(mission.spacecraft_id, *std::move(model));
    } else {
      problems += (problems.empty() ? "" : "\n") + model.error().message;
    }
  }
  if (!problems.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration, problems}};
  }
  return models;
}

}  // namespace spindrift
