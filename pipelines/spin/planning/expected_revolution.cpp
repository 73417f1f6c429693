#include "pipelines/spin/planning/expected_revolution.h"

#include <cmath>
#include <cstddef>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/association/expected_phases.h"

namespace spindrift {
namespace {

using enum PulseChannel;

double ahead_rad(double from_rad, double to_rad) {
  const double ahead = std::fmod(to_rad - from_rad, kTurn_rad);
  return ahead < 0.0 ? ahead + kTurn_rad : ahead;
}

/// Phase of slit 1 at a time.
struct Mark {
  TaiTime t;
  double phase_rad;
};

struct Turning {
  PlacedSensors sensors;
  const Sky& sky;
  const Eigen::Matrix3d& R_spin_icrf;
  double rate_rad_s;

  /// Returns the channel's first edge behind a mark, and sets `t` to its time. It iterates since
  /// the Earth moves on until then, ten thousand times slower than the body turns.
  std::optional<PredictedEdge> edge_behind(const Mark& mark, PulseChannel channel,
                                           TaiTime& t) const {
    constexpr int kApproaches = 3;
    t = mark.t;
    std::optional<PredictedEdge> edge;
    for (int i = 0; i <= kApproaches; ++i) {
      edge = predict_edge(sensors, sky, R_spin_icrf, {.t = t, .channel = channel});
      if (!edge) {
        break;
      }
      t = shifted(mark.t, ahead_rad(mark.phase_rad, edge->phase_rad) / rate_rad_s);
    }
    return edge;
  }
};

void add_edge(const Turning& turning, const Mark& mark, PulseChannel channel,
              ExpectedRevolution& expected) {
  TaiTime t;
  const std::size_t i = index_of(channel);
  expected.predicted.at(i) = turning.edge_behind(mark, channel, t);
  if (expected.predicted.at(i)) {
    expected.revolution.edges.at(i) = t;
  }
}

/// Adds both edges of a chord. Its end is searched behind its beginning, where there is one.
void add_chord(const Turning& turning, const Mark& start, PulseChannel in, PulseChannel out,
               ExpectedRevolution& expected) {
  add_edge(turning, start, in, expected);
  const auto& begins = expected.revolution.edge(in);
  const Mark mark =
      begins ? Mark{.t = *begins, .phase_rad = expected.predicted.at(index_of(in))->phase_rad}
             : start;
  add_edge(turning, mark, out, expected);
}

bool meet(const SpinConfig& config, double rate_rad_s, const ExpectedRevolution& expected,
          PulseChannel one, PulseChannel other) {
  const auto& a = expected.predicted.at(index_of(one));
  const auto& b = expected.predicted.at(index_of(other));
  if (!a || !b) {
    return false;
  }
  const double apart_s =
      std::abs(std::remainder(a->phase_rad - b->phase_rad, kTurn_rad)) / rate_rad_s;
  const double sigma_s =
      std::hypot(edge_sigma_s(config.noise, one), edge_sigma_s(config.noise, other));
  return apart_s < config.screening.interference_s + kInterferenceSigmas * sigma_s;
}

void find_meeting(const SpinConfig& config, double rate_rad_s, ExpectedRevolution& expected) {
  if (!(config.screening.interference_s > 0.0)) {
    return;
  }
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    for (std::size_t j = i + 1; j < kPulseChannels; ++j) {
      const auto one = static_cast<PulseChannel>(i);
      const auto other = static_cast<PulseChannel>(j);
      if (meet(config, rate_rad_s, expected, one, other)) {
        expected.meeting.push_back({.one = one, .other = other});
        expected.revolution.edge_rejections.at(i) = Rejection::Interference;
        expected.revolution.edge_rejections.at(j) = Rejection::Interference;
      }
    }
  }
}

}  // namespace

ExpectedRevolution expected_revolution(const SpinConfig& config, const Sky& sky,
                                       const Eigen::Matrix3d& R_spin_icrf, double rate_rad_s,
                                       bool sun_hidden) {
  ExpectedRevolution expected{
      .revolution = {.number = 0,
                     .edges = {},
                     .period_candidate = {},
                     .period = {.period_s = kTurn_rad / rate_rad_s, .sigma_s = 0.0},
                     .t_start = sky.t},
      .predicted = {},
      .meeting = {}};
  const Turning turning{{config, SensorBiases::Zero()}, sky, R_spin_icrf, rate_rad_s};
  const Eigen::Vector3d sun_spin = R_spin_icrf * sky.sun_icrf;
  const Mark start{.t = sky.t, .phase_rad = std::atan2(sun_spin.y(), sun_spin.x())};
  if (!sun_hidden) {
    add_edge(turning, start, Sun1, expected);
    add_edge(turning, start, Sun2, expected);
  }
  add_chord(turning, start, NorthIn, NorthOut, expected);
  add_chord(turning, start, SouthIn, SouthOut, expected);
  find_meeting(config, rate_rad_s, expected);
  return expected;
}

}  // namespace spindrift
