#include "pipelines/spin/batch/pass_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/surroundings.h"
#include "pipelines/spin/time_span.h"

namespace spindrift {
namespace {

// Within it the Sun moves by 0.0001 deg, and a satellite's fall from its second order by 1 m.
constexpr double kSkySpan_s = 10.0;

}  // namespace

PassModel::PassModel(SpinConfig config, TaiTime first, TaiTime last)
    : config_{std::move(config)},
      first_{first},
      middle_{first + (last - first) / 2},
      half_s_{std::max(0.5 * seconds_between(first, last), 1.0)} {}

Expected<PassModel> PassModel::make(const SpinConfig& config, const Orbit& orbit,
                                    std::span<const PassEdge> edges) {
  const TaiTime first = edges.front().pulse.t;
  const TaiTime last = edges.back().pulse.t;
  PassModel model{config, first, last};
  Surroundings surroundings{orbit, config.horizon.co2_altitude_km};
  const double length_s = seconds_between(first, last);
  for (double t_s = 0.0; t_s <= length_s; t_s += kSkySpan_s) {
    const double middle_s = std::min(t_s + 0.5 * kSkySpan_s, length_s);
    auto sky = surroundings.sky(later_by_s(first, middle_s));
    if (!sky) {
      return Unexpected{sky.error()};
    }
    model.skies_.push_back(*std::move(sky));
  }
  return model;
}

const Sky& PassModel::sky_at(TaiTime t) const {
  const double span = std::max(seconds_between(first_, t) / kSkySpan_s, 0.0);
  return skies_[std::min(static_cast<std::size_t>(span), skies_.size() - 1)];
}

std::optional<MetEdge> PassModel::meet(const Pulse& edge, const SpinState& state) const {
  const Eigen::Matrix3d R_spin_icrf = state.q_icrf_spin.conjugate().toRotationMatrix();
  const auto expected = predict_edge(config_, sky_at(edge.t), R_spin_icrf, edge, state.biases);
  if (!expected) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(middle_, edge.t);
  const double rate_there_rad_s = state.rate_rad_s + state.drift_rad_s2 * dt_s;
  const double phase_rad = (state.rate_rad_s + 0.5 * state.drift_rad_s2 * dt_s) * dt_s;
  return MetEdge{.expected = *expected,
                 .phase_rad = phase_rad,
                 .off_rad = wrapped_rad(phase_rad - expected->phase_rad),
                 .sigma_rad = rate_there_rad_s * edge_sigma_s(config_.noise, edge.channel),
                 .rate_rad_s = rate_there_rad_s};
}

std::optional<EdgeResidual> PassModel::residual(const Pulse& edge, const SpinState& state) const {
  const auto met = meet(edge, state);
  if (!met) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(middle_, edge.t);
  const double part = dt_s / half_s_;
  EdgeResidual residual;
  residual.off = met->off_rad / met->sigma_rad;
  residual.slopes << -met->expected.phase_per_rotation.transpose(), part, part * part,
      -met->expected.phase_per_bias;
  residual.slopes /= met->sigma_rad;
  // What an angle is worth changes with the rate as well; to first order.
  const double by_rate = -residual.off / met->rate_rad_s;
  residual.slopes[3] += by_rate / half_s_;
  residual.slopes[4] += by_rate * 2.0 * dt_s / (half_s_ * half_s_);
  return residual;
}

}  // namespace spindrift
