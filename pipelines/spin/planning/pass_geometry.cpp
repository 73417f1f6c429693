#include "pipelines/spin/planning/pass_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/association/expected_phases.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "pipelines/spin/measurement/measurement.h"

namespace spindrift {
namespace {

using enum PulseChannel;

/// Tells how a beam that gives no edges lies to the disc of a spherical Earth.
BeamSight view_without_edges(double mount_angle_rad, double earth_angle_rad, double disc_rad) {
  if (predict_chord_rad(mount_angle_rad, earth_angle_rad, disc_rad)) {
    return BeamSight::NearTangent;
  }
  return std::abs(earth_angle_rad - mount_angle_rad) < disc_rad ? BeamSight::Inside
                                                                : BeamSight::Misses;
}

/// Does the same as `SunEarthEphemeris::sun_earth`, but from the sky, which also knows the end of
/// the turn where the orbit ends before it.
SunEarthDirections sightlines_of(const Sky& sky, const RevolutionMeasurements& measured,
                                 double disc_rad) {
  TaiTime first = sky.t;
  TaiTime last = sky.t;
  bool none = true;
  for (const auto& crossing : measured.crossings) {
    if (crossing) {
      first = none ? crossing->t_mid() : std::min(first, crossing->t_mid());
      last = none ? crossing->t_mid() : std::max(last, crossing->t_mid());
      none = false;
    }
  }
  const TaiTime t_earth = first + (last - first) / 2;
  const Eigen::Vector3d earth_icrf_km = -spacecraft_icrf_km(sky, t_earth);
  return {.sun_icrf = sky.sun_icrf,
          .earth_icrf = earth_icrf_km.normalized(),
          .disc_rad = disc_rad,
          .earth_pole_icrf = sky.earth_pole_icrf,
          .t_earth = t_earth,
          .earth_motion_icrf_s = -sky.spacecraft.velocity_icrf_km_s / earth_icrf_km.norm()};
}

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

DeltaClass class_of(const SpinGeometry& limits, double delta) {
  if (std::abs(delta) >= limits.determinant_usable) {
    return DeltaClass::Usable;
  }
  return std::abs(delta) > limits.determinant_ambiguous ? DeltaClass::TwoRoots
                                                        : DeltaClass::Ambiguous;
}

PassScene::PassScene(SpinConfig config, Orbit orbit, const Eigen::Vector3d& axis_icrf,
                     double rate_rad_s)
    : config_{std::move(config)},
      on_sphere_{config_},
      around_{std::move(orbit), config_.horizon.co2_altitude_km},
      axis_icrf_{axis_icrf},
      rate_rad_s_{rate_rad_s} {
  on_sphere_.horizon.model = HorizonModel::Sphere;
  R_spin_icrf_ << tangent_basis(axis_icrf).transpose(), axis_icrf.transpose();
}

BeamGeometry PassScene::beam(Side side, const PassGeometry& geometry) const {
  const auto& sensor = sensor_of(config_, side);
  if (!sensor) {
    return {.view = BeamSight::NoSensor, .chord_rad = {}, .delta = {}};
  }
  const Revolution& turn = geometry.expected.revolution;
  const auto& in = turn.edge(kInChannels.at(index_of(side)));
  const auto& out = turn.edge(kOutChannels.at(index_of(side)));
  if (!in || !out) {
    return {.view = view_without_edges(sensor->mount_angle_rad, geometry.angles.earth_angle_rad,
                                       geometry.disc_rad),
            .chord_rad = {},
            .delta = {}};
  }
  BeamGeometry found{
      .view = BeamSight::Crosses, .chord_rad = turn.turned_rad(*in, *out), .delta = {}};
  if (turn.edge(PulseChannel::Sun1) && turn.edge(PulseChannel::Sun2)) {
    found.delta = determinant(OneChordInput<double>{
        .chord = {.mount_angle_rad = sensor->mount_angle_rad, .chord_rad = *found.chord_rad},
        .sun_angle_rad = geometry.angles.sun_angle_rad,
        .dihedral_rad = geometry.angles.dihedral_rad,
        .sun_earth_rad = geometry.sun_earth_rad,
        .disc_rad = geometry.disc_rad});
  }
  return found;
}

/// Returns the turn on the sphere that fixes are solved on, with those edges only that exist on the
/// true horizon.
Revolution PassScene::turn_on_sphere(const Sky& sky, const PassGeometry& geometry) const {
  Revolution turn =
      expected_revolution(on_sphere_, sky, R_spin_icrf_, rate_rad_s_, geometry.sun_hidden)
          .revolution;
  const Revolution& there = geometry.expected.revolution;
  turn.edge_rejections = there.edge_rejections;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    if (!there.edges.at(i)) {
      turn.edges.at(i).reset();
    }
  }
  return turn;
}

FixGeometry PassScene::fix(const Sky& sky, const PassGeometry& geometry) const {
  const RevolutionMeasurements measured = measure(on_sphere_, turn_on_sphere(sky, geometry));
  FixGeometry fix{
      .geometry_case = geometry_case_of(measured), .axes = 0, .told_apart = false, .sigma_rad = {}};
  const auto found =
      axis_candidates(on_sphere_, measured, sightlines_of(sky, measured, geometry.disc_rad));
  if (!found) {
    return fix;
  }
  fix.geometry_case = found->geometry_case;
  fix.axes = found->candidates.size();
  fix.told_apart = found->told_apart;
  const auto from_truth_rad = [&](const AxisCandidate& candidate) {
    return angle_between_rad(candidate.axis_icrf, axis_icrf_);
  };
  const auto truest = std::min_element(
      found->candidates.begin(), found->candidates.end(),
      [&](const auto& a, const auto& b) { return from_truth_rad(a) < from_truth_rad(b); });
  fix.sigma_rad = std::sqrt(truest->total_covariance_rad2().trace());
  return fix;
}

Expected<PassGeometry> PassScene::at(TaiTime t) {
  const auto sky = around_.sky(t);
  if (!sky) {
    return Unexpected{sky.error()};
  }
  const double range_km = sky->spacecraft.position_icrf_km.norm();
  const auto disc_rad = earth_disc_half_angle_rad(range_km, config_.horizon.co2_altitude_km);
  if (!disc_rad) {
    return Unexpected{disc_rad.error()};
  }
  const Eigen::Vector3d earth_icrf = -sky->spacecraft.position_icrf_km / range_km;
  const double sun_earth_rad = angle_between_rad(sky->sun_icrf, earth_icrf);
  const bool sun_hidden = sun_earth_rad < *disc_rad;
  PassGeometry geometry{
      .t = t,
      .range_km = range_km,
      .angles = predict_angles(axis_icrf_, sky->sun_icrf, earth_icrf),
      .sun_earth_rad = sun_earth_rad,
      .disc_rad = *disc_rad,
      .sun_hidden = sun_hidden,
      .in_line = in_line(sun_earth_rad),
      .beams = {},
      .expected = expected_revolution(config_, *sky, R_spin_icrf_, rate_rad_s_, sun_hidden),
      .fix = {}};
  for (const Side side : kSides) {
    geometry.beams.at(index_of(side)) = beam(side, geometry);
  }
  geometry.fix = fix(*sky, geometry);
  return geometry;
}

}  // namespace spindrift
