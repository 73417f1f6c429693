#include "pipelines/spin/batch/pass_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/spin/measurement/sun_earth_ephemeris.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// Within this span the Sun moves by 0.0001 deg and an orbit leaves its second order by 1 m.
constexpr double kSkySpan_s = 10.0;

const NutationStretch* stretch_at(const SpinState& state, TaiTime t) {
  const auto found = std::upper_bound(
      state.nutation.begin(), state.nutation.end(), t,
      [](TaiTime time, const NutationStretch& stretch) { return time < stretch.end; });
  return found != state.nutation.end() && found->holds(t) ? &*found : nullptr;
}

/// Converts slopes with respect to the tipped axes to slopes with respect to the untipped axes.
void untip(const NutationTilt& tilt, ComparedEdge& met) {
  const Eigen::Vector3d tipped_rad{tilt.rotation_rad.x(), tilt.rotation_rad.y(), 0.0};
  const Eigen::Vector3d per_tipped = met.expected.phase_per_rotation;
  const Eigen::RowVector2d per_tilt =
      per_tipped.transpose() * rotation_per_vector(-tipped_rad).leftCols<2>();
  met.expected.phase_per_rotation = rotation_by(tipped_rad) * per_tipped;
  met.off_per_phase = 1.0 - per_tilt.dot(tilt.per_phase);
  met.off_per_nutation = -per_tilt * tilt.per_unknown;
}

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
  SunEarthEphemeris surroundings{orbit, config.horizon.co2_altitude_km};
  for (const PassEdge& edge : edges) {
    const std::size_t span = model.span_of(edge.pulse.t);
    if (span < model.skies_.size()) {
      continue;
    }
    const TaiTime middle = later_by_s(first, (static_cast<double>(span) + 0.5) * kSkySpan_s);
    auto sky = surroundings.sky(std::min(middle, last));
    if (!sky) {
      sky = surroundings.sky(edge.pulse.t);  // The middle may lie in a gap of the orbit.
    }
    if (!sky) {
      return Unexpected{sky.error()};
    }
    // Spans without an edge are filled but never used.
    model.skies_.resize(span + 1, *sky);
  }
  return model;
}

std::size_t PassModel::span_of(TaiTime t) const {
  return static_cast<std::size_t>(std::max(seconds_between(first_, t) / kSkySpan_s, 0.0));
}

const Sky& PassModel::sky_at(TaiTime t) const {
  return skies_[std::min(span_of(t), skies_.size() - 1)];
}

PassAtState::PassAtState(const PassModel& model, SpinState state)
    : model_{&model},
      state_{std::move(state)},
      R_spin_icrf_{state_.q_icrf_spin.conjugate().toRotationMatrix()},
      sensors_{model.config(), state_.biases} {}

std::optional<ComparedEdge> PassAtState::meet(const Pulse& edge) const {
  const double dt_s = seconds_between(model_->middle(), edge.t);
  const double rate_there_rad_s = state_.rate_rad_s + state_.drift_rad_s2 * dt_s;
  const double phase_rad = (state_.rate_rad_s + 0.5 * state_.drift_rad_s2 * dt_s) * dt_s;
  Eigen::Matrix3d R_tipped_icrf = R_spin_icrf_;
  std::optional<NutationTilt> tilt;
  if (const NutationStretch* const stretch = stretch_at(state_, edge.t)) {
    tilt = tilt_at(*stretch, edge.t, phase_rad);
    R_tipped_icrf =
        rotation_by({-tilt->rotation_rad.x(), -tilt->rotation_rad.y(), 0.0}) * R_tipped_icrf;
  }
  const auto expected = predict_edge(sensors_, model_->sky_at(edge.t), R_tipped_icrf, edge);
  if (!expected) {
    return std::nullopt;
  }
  ComparedEdge met{
      .expected = *expected,
      .phase_rad = phase_rad,
      .off_rad = wrapped_rad(phase_rad - expected->phase_rad),
      .sigma_rad = rate_there_rad_s * edge_sigma_s(model_->config().noise, edge.channel),
      .rate_rad_s = rate_there_rad_s};
  if (tilt) {
    untip(*tilt, met);
  }
  return met;
}

std::optional<EdgeResidual> PassAtState::residual(const Pulse& edge) const {
  const auto met = meet(edge);
  if (!met) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(model_->middle(), edge.t);
  const double half_s = model_->half_s();
  const double part = dt_s / half_s;
  EdgeResidual residual;
  residual.off = met->off_rad / met->sigma_rad;
  residual.slopes << -met->expected.phase_per_rotation.transpose(), met->off_per_phase * part,
      met->off_per_phase * part * part, -met->expected.phase_per_bias;
  residual.slopes /= met->sigma_rad;
  residual.nutation_slopes = met->off_per_nutation / met->sigma_rad;
  residual.per_alignment = met->expected.phase_per_alignment / met->sigma_rad;
  // A timing error corresponds to an angle through the rate, so the rate adds a first-order slope.
  const double by_rate = -residual.off / met->rate_rad_s;
  residual.slopes[3] += by_rate / half_s;
  residual.slopes[4] += by_rate * 2.0 * dt_s / (half_s * half_s);
  return residual;
}

}  // namespace spindrift
