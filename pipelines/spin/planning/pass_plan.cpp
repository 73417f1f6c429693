#include "pipelines/spin/planning/pass_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// Conditions are looked for this often: channels that meet may part within seconds, and no function
// to search tells when.
constexpr double kLook_s = 1.0;

struct Node {
  double place;  ///< Position as a share of the stretch.
  double weight;
};
const std::array<Node, 3> kNodes = {{{0.5 - 0.5 * std::sqrt(0.6), 5.0 / 18.0},
                                     {0.5, 8.0 / 18.0},
                                     {0.5 + 0.5 * std::sqrt(0.6), 5.0 / 18.0}}};

class Planner {
 public:
  Planner(PassScene scene, TaiTime start) : scene_{std::move(scene)}, start_{start}, t_{start} {}

  /// Advances to a later time, or to the start itself.
  Expected<PassStep> step_to(TaiTime t) {
    // The information of many turns is an integral, by Gauss and Legendre over stretches this long.
    const auto stretches = static_cast<std::int64_t>(std::ceil(seconds_between(t_, t) / 10.0));
    const double length_s = seconds_between(t_, t) / static_cast<double>(stretches);
    const TaiTime from = t_;
    for (std::int64_t i = 1; i < stretches; ++i) {
      const auto passed = stretch_to(shifted(from, static_cast<double>(i) * length_s));
      if (!passed) {
        return Unexpected{passed.error()};
      }
    }
    return stretch_to(t).map(
        [this](PassGeometry geometry) { return step_of(std::move(geometry)); });
  }

  std::vector<PassEvent> finish() { return events_.finish(); }

 private:
  Expected<PassGeometry> stretch_to(TaiTime t) {
    const double length_s = seconds_between(t_, t);
    for (const Node& node : kNodes) {
      const auto geometry = scene_.at(shifted(t_, node.place * length_s));
      if (!geometry) {
        return Unexpected{geometry.error()};
      }
      add_turns(geometry->expected, node.weight * length_s * scene_.rate_rad_s() / kTurn_rad);
    }
    for (double after_s = kLook_s; after_s < length_s; after_s += kLook_s) {
      if (const auto looked = look_at(shifted(t_, after_s)); !looked) {
        return Unexpected{looked.error()};
      }
    }
    t_ = t;
    return look_at(t);
  }

  Expected<PassGeometry> look_at(TaiTime t) {
    auto geometry = scene_.at(t);
    if (geometry) {
      events_.advance_to(t, conditions_of(scene_.config(), *geometry));
    }
    return geometry;
  }

  /// Adds the information of `turns` equal turns.
  void add_turns(const ExpectedRevolution& turn, double turns) {
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      const auto channel = static_cast<PulseChannel>(i);
      if (const auto t = turn.revolution.good_edge(channel)) {
        information_.add(*turn.predicted.at(i), seconds_between(start_, *t),
                         scene_.rate_rad_s() * edge_sigma_s(scene_.config().noise, channel), turns);
      }
    }
  }

  PassStep step_of(PassGeometry geometry) const {
    PassStep step{.geometry = std::move(geometry), .sigma_rad = {}, .noise_sigma_rad = {}};
    const auto noise_rad2 = information_.axis_covariance_rad2();
    const auto per_alignment = information_.axis_per_alignment();
    if (noise_rad2 && per_alignment) {
      const SpinAlignment& alignment = scene_.config().alignment;
      const double noise = noise_rad2->trace();
      step.noise_sigma_rad = std::sqrt(noise);
      step.sigma_rad =
          std::sqrt(noise + (*per_alignment * alignment * per_alignment->transpose()).trace());
      step.alignment_sigma_rad = (per_alignment->colwise().squaredNorm().transpose().array() *
                                  alignment.diagonal().array())
                                     .sqrt();
    }
    return step;
  }

  PassScene scene_;
  TaiTime start_;
  TaiTime t_;
  EdgeInformation information_;
  PassEvents events_;
};

}  // namespace

void PassEvents::advance_to(TaiTime t, const std::vector<PassCondition>& conditions) {
  last_ = t;
  for (auto event = open_.begin(); event != open_.end();) {
    if (std::find(conditions.begin(), conditions.end(), event->condition) != conditions.end()) {
      ++event;
      continue;
    }
    event->to = t;
    closed_.push_back(std::move(*event));
    event = open_.erase(event);
  }
  for (const PassCondition& condition : conditions) {
    if (std::none_of(open_.begin(), open_.end(),
                     [&](const auto& event) { return event.condition == condition; })) {
      open_.push_back({.from = t, .to = t, .condition = condition});
    }
  }
}

std::vector<PassEvent> PassEvents::finish() {
  for (PassEvent& event : open_) {
    event.to = last_;
    closed_.push_back(std::move(event));
  }
  open_.clear();
  std::stable_sort(closed_.begin(), closed_.end(),
                   [](const PassEvent& a, const PassEvent& b) { return a.from < b.from; });
  return std::move(closed_);
}

Expected<PassPlan> plan_pass(const SpinConfig& config, const Orbit& orbit,
                             const PassRequest& request) {
  PassScene scene{config, orbit, request.axis_icrf, request.rate_rad_s};
  // Both ends are tried first, so that the error says how much of the pass the orbit does not
  // reach.
  for (const TaiTime end : {request.from, request.to}) {
    if (const auto geometry = scene.at(end); !geometry) {
      return Unexpected{geometry.error()};
    }
  }
  Planner planner{std::move(scene), request.from};
  PassPlan plan;
  TaiTime t = request.from;
  for (std::int64_t i = 1;; ++i) {
    auto step = planner.step_to(t);
    if (!step) {
      return Unexpected{step.error()};
    }
    plan.steps.push_back(std::move(*step));
    if (t == request.to) {
      break;
    }
    t = std::min(later_by_s(request.from, static_cast<double>(i) * request.step_s), request.to);
  }
  plan.events = planner.finish();
  return plan;
}

}  // namespace spindrift
