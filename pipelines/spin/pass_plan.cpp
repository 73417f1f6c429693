#include "pipelines/spin/pass_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "pipelines/spin/edge_information.h"
#include "pipelines/spin/edge_prediction.h"
#include "pipelines/spin/pass_events.h"

namespace spindrift {
namespace {

// The information of many turns is an integral; by Gauss and Legendre over so short stretches.
constexpr double kStretch_s = 60.0;

struct Node {
  double place;  ///< Share of the stretch.
  double weight;
};
const std::array<Node, 3> kNodes = {{{0.5 - 0.5 * std::sqrt(0.6), 5.0 / 18.0},
                                     {0.5, 8.0 / 18.0},
                                     {0.5 + 0.5 * std::sqrt(0.6), 5.0 / 18.0}}};

/// Adds a turn that is one of `turns` alike.
void add_turn(const PassScene& scene, const ExpectedRevolution& turn, TaiTime start, double turns,
              EdgeInformation& information) {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (const auto t = turn.revolution.good_edge(channel)) {
      information.add(*turn.predicted.at(i), seconds_between(start, *t),
                      scene.rate_rad_s() * edge_sigma_s(scene.config().noise, channel), turns);
    }
  }
}

Expected<void> add_turns(PassScene& scene, TaiTime start, TaiTime from, TaiTime to,
                         EdgeInformation& information) {
  const auto stretches =
      static_cast<std::int64_t>(std::ceil(seconds_between(from, to) / kStretch_s));
  const double length_s = seconds_between(from, to) / static_cast<double>(stretches);
  const double turns = length_s * scene.rate_rad_s() / (2.0 * std::numbers::pi);
  for (std::int64_t i = 0; i < stretches; ++i) {
    for (const Node& node : kNodes) {
      const auto geometry =
          scene.at(shifted(from, (static_cast<double>(i) + node.place) * length_s));
      if (!geometry) {
        return Unexpected{geometry.error()};
      }
      add_turn(scene, geometry->expected, start, turns * node.weight, information);
    }
  }
  return {};
}

std::optional<double> sigma_rad(const EdgeInformation& information) {
  const auto covariance_rad2 = information.axis_covariance_rad2();
  return covariance_rad2 ? std::optional{std::sqrt(covariance_rad2->trace())} : std::nullopt;
}

}  // namespace

Expected<PassPlan> plan_pass(const SpinConfig& config, const Orbit& orbit,
                             const PassRequest& request) {
  PassScene scene{config, orbit, request.axis_icrf, request.rate_rad_s};
  PassPlan plan;
  EdgeInformation information;
  TaiTime before = request.from;
  for (std::int64_t i = 0; before < request.to || i == 0; ++i) {
    const TaiTime t =
        std::min(shifted(request.from, static_cast<double>(i) * request.step_s), request.to);
    if (const auto added = add_turns(scene, request.from, before, t, information); !added) {
      return Unexpected{added.error()};
    }
    auto geometry = scene.at(t);
    if (!geometry) {
      return Unexpected{geometry.error()};
    }
    plan.steps.push_back({.geometry = std::move(*geometry), .sigma_rad = sigma_rad(information)});
    before = t;
  }
  return pass_events(scene, plan.steps).map([&](std::vector<PassEvent> events) {
    plan.events = std::move(events);
    return std::move(plan);
  });
}

}  // namespace spindrift
