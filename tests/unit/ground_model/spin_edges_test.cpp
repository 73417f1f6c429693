#include "pipelines/ground_model/sensors/spin_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/spin_truth.h"

namespace spindrift::testing::spin_edges_test {

constexpr double kRpm = std::numbers::pi / 30.0;
constexpr TaiTime kStart = tai_from_ns(1795143637000000000);  // 2026-11-20.
const Eigen::Vector3d kIcrfPole = Eigen::Vector3d::UnitZ();

Orbit orbit_of(double a_km, double e, double mean_anomaly_rad) {
  return Orbit{KeplerOrbit::make({.epoch = kStart,
                                  .semi_major_axis_km = a_km,
                                  .eccentricity = e,
                                  .inclination_rad = 28.5 * kRadPerDeg,
                                  .raan_rad = 300.0 * kRadPerDeg,
                                  .argument_of_perigee_rad = 178.0 * kRadPerDeg,
                                  .mean_anomaly_rad = mean_anomaly_rad})
                   .value()};
}

Eigen::Vector3d place(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

const Orbit kTransfer = orbit_of(24400.0, 0.73, 0.5);
const Orbit kRing = orbit_of(42164.0, 0.0, 1.0);  // The geostationary one.

SpinTruth truth_of(const Eigen::Vector3d& axis_icrf, double rpm, HorizonModel horizon) {
  SpinConfig config = usual_config();
  config.horizon.model = horizon;
  SpinTruth truth = testing::truth_of({axis_icrf, rpm * kRpm, 1.0, config});
  truth.horizon.pole_icrf = kIcrfPole;
  return truth;
}

/// Returns the truth of the scenarios' transfer orbit.
SpinTruth usual_truth(HorizonModel horizon) { return truth_of(place(100.0, -55.0), 60.0, horizon); }

std::vector<TrueEdge> edges_of(const SpinTruth& truth, const Orbit& orbit, double end_s) {
  SpinEdges edges{truth, orbit};
  return edges.until(end_s).value();
}

/// Returns the oracle's time: its spin is constant, so a drifting angle is converted to a time.
double turned_s(const SpinMotion& motion, double t_s) {
  return (motion.azimuth_rad(t_s) - motion.first_azimuth_rad) / motion.rate_rad_s;
}
double time_s(const SpinMotion& motion, double turned_s) {
  const double ratio = motion.rate_drift_rad_s2 / motion.rate_rad_s;
  return ratio == 0.0 ? turned_s : (std::sqrt(1.0 + 2.0 * ratio * turned_s) - 1.0) / ratio;
}

std::vector<Edge> oracle(const SpinTruth& truth, const Orbit& orbit, double from_s, double to_s) {
  const SpinMotion& motion = truth.motion;
  // The oracle's Earth has its pole along z, so everything is rotated accordingly.
  const Eigen::Quaterniond upright = frame_about(truth.horizon.pole_icrf).conjugate();
  const Eigen::Vector3d axis = upright * motion.axis_icrf;
  const Eigen::Vector3d zero = upright.conjugate() * (frame_about(axis) * Eigen::Vector3d::UnitX());
  const Eigen::Vector2d zero_plane = tangent_basis(motion.axis_icrf).transpose() * zero;
  SpinConfig config = usual_config();
  config.sun_sensor = truth.sun_sensor;
  config.north->mount_angle_rad = truth.north->mount_angle_rad;
  config.south->mount_angle_rad = truth.south->mount_angle_rad;
  const SpinningBody body = {
      .axis_icrf = axis,
      .rate_rad_s = motion.rate_rad_s,
      .first_turn_rad = motion.first_azimuth_rad - std::atan2(zero_plane.y(), zero_plane.x()),
      .config = config};
  ApparentSun sun;
  const auto state = [&](double turned) {
    return orbit.at(shifted(truth.start, time_s(motion, turned))).value();
  };
  const SunEarthEphemeris around = {
      .sun_icrf = [&](double turned) -> Eigen::Vector3d {
        return upright *
               sun.direction_icrf(shifted(truth.start, time_s(motion, turned)), state(turned));
      },
      .earth_icrf_km = [&](double turned) -> Eigen::Vector3d {
        return upright * -state(turned).position_icrf_km;
      },
      .horizon_km = {truth.horizon.equatorial_km, truth.horizon.equatorial_km,
                     truth.horizon.polar_km}};
  auto edges = edges_between(body, around, turned_s(motion, from_s), turned_s(motion, to_s));
  for (Edge& edge : edges) {
    edge.t_s = time_s(motion, edge.t_s);
  }
  return edges;
}

template <class Edge>
void expect_same(const std::vector<TrueEdge>& edges, const std::vector<Edge>& expected,
                 double within_s) {
  ASSERT_EQ(edges.size(), expected.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ASSERT_EQ(name_of(edges[i].channel), name_of(expected[i].channel)) << i;
    ASSERT_NEAR(edges[i].t_s, expected[i].t_s, within_s) << i << ' ' << name_of(edges[i].channel);
  }
}

void expect_the_oracles_edges(const SpinTruth& truth, const Orbit& orbit, double from_s,
                              double to_s) {
  std::vector<TrueEdge> edges = edges_of(truth, orbit, to_s);
  std::erase_if(edges, [&](const TrueEdge& edge) { return edge.t_s < from_s; });
  const auto expected = oracle(truth, orbit, from_s, to_s);
  ASSERT_GT(expected.size(), 0U);
  expect_same(edges, expected, 1e-9);
}

struct Case {
  std::string name;
  Eigen::Vector3d axis_icrf;
  double rpm;
  Orbit orbit;
};

std::vector<Case> cases() {
  return {{"transfer orbit", place(100.0, -55.0), 60.0, kTransfer},
          {"slowest spin on the transfer orbit", place(100.0, -55.0), 5.0, kTransfer},
          {"fastest spin", place(120.0, -60.0), 200.0, kTransfer},
          {"geostationary ring, axis near the pole", place(54.0, -89.5), 100.0, kRing},
          {"axis at the pole itself", place(0.0, 90.0), 30.0, orbit_of(42164.0, 0.001, 2.0)},
          {"low orbit, slow", place(210.0, 62.0), 5.0, orbit_of(6900.0, 0.001, 3.0)}};
}

TEST(SpinEdges, AreThoseOfTheOracleOnTheSphereAndOnTheEllipsoid) {
  for (const Case& each : cases()) {
    for (const HorizonModel horizon : {HorizonModel::Sphere, HorizonModel::Ellipsoid}) {
      SCOPED_TRACE(each.name + (horizon == HorizonModel::Sphere ? ", sphere" : ", ellipsoid"));
      const SpinTruth truth = truth_of(each.axis_icrf, each.rpm, horizon);
      expect_the_oracles_edges(truth, each.orbit, 0.0, 30.3 * 60.0 / each.rpm);
    }
  }
}

/// Returns the edges of chords, or gaps between chords, that are longer than `least_s`.
std::vector<double> wide_edges_s(const std::vector<Edge>& edges, PulseChannel channel,
                                 PulseChannel opposite, double least_s) {
  std::vector<double> wide_s;
  for (const Edge& edge : edges) {
    const bool narrow = std::ranges::any_of(edges, [&](const Edge& other) {
      return other.channel == opposite && std::abs(other.t_s - edge.t_s) < least_s;
    });
    if (edge.channel == channel && !narrow) {
      wide_s.push_back(edge.t_s);
    }
  }
  return wide_s;
}

bool has_all(const std::vector<double>& all_s, const std::vector<double>& wanted_s) {
  return std::ranges::all_of(wanted_s, [&](double t_s) {
    return std::ranges::any_of(all_s,
                               [t_s](double other_s) { return std::abs(other_s - t_s) < 1e-8; });
  });
}

void expect_the_oracles_wide_edges(const SpinTruth& truth, const Orbit& orbit, double end_s) {
  using enum PulseChannel;
  std::vector<Edge> found;
  for (const TrueEdge& edge : edges_of(truth, orbit, end_s)) {
    found.push_back({.t_s = edge.t_s, .channel = edge.channel});
  }
  const auto expected = oracle(truth, orbit, 0.0, end_s);
  // One degree, since the model checks for narrow chords at one time and the oracle at two.
  const double narrow_s = kRadPerDeg / truth.motion.rate_rad_s;
  for (const auto& [channel, opposite] :
       {std::pair{NorthIn, NorthOut}, std::pair{NorthOut, NorthIn}, std::pair{SouthIn, SouthOut},
        std::pair{SouthOut, SouthIn}}) {
    SCOPED_TRACE(name_of(channel));
    EXPECT_TRUE(has_all(wide_edges_s(found, channel, opposite, 0.0),
                        wide_edges_s(expected, channel, opposite, narrow_s)));
    EXPECT_TRUE(has_all(wide_edges_s(expected, channel, opposite, 0.0),
                        wide_edges_s(found, channel, opposite, 0.0)));
  }
}

/// In a low orbit a chord appears, grows to a whole turn and vanishes within minutes.
TEST(SpinEdges, AreThoseOfTheOracleWhereAChordComesOrGoes) {
  std::mt19937_64 rng{20261123};
  const auto uniform = [&rng](double from, double to) {
    return std::uniform_real_distribution<double>{from, to}(rng);
  };
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
    const HorizonModel horizon = i % 2 == 0 ? HorizonModel::Sphere : HorizonModel::Ellipsoid;
    const double ra_deg = uniform(0.0, 360.0);
    SpinTruth truth = truth_of(place(ra_deg, uniform(-89.0, 89.0)), uniform(5.0, 30.0), horizon);
    truth.north->mount_angle_rad = uniform(20.0, 160.0) * kRadPerDeg;
    truth.south->mount_angle_rad = uniform(20.0, 160.0) * kRadPerDeg;
    const double a_km = uniform(7000.0, 9000.0);
    expect_the_oracles_wide_edges(truth, orbit_of(a_km, 0.001, uniform(0.0, 6.28)), 1500.0);
  }
}

TEST(SpinEdges, GoOnWhereABeamNoLongerLeavesTheEarth) {
  SpinTruth truth = truth_of(place(350.0, 20.0), 60.0, HorizonModel::Sphere);
  truth.north->mount_angle_rad = 30.0 * kRadPerDeg;
  expect_the_oracles_wide_edges(truth, orbit_of(7000.0, 0.001, 30.0 * kRadPerDeg), 1200.0);
}

TEST(SpinEdges, AreThoseOfTheOracleAfterADay) {
  const SpinTruth truth = truth_of(place(54.0, -80.0), 100.0, HorizonModel::Ellipsoid);
  expect_the_oracles_edges(truth, kRing, 86400.0, 86410.0);
}

TEST(SpinEdges, FollowADriftOfTheRate) {
  for (const double drift_rad_s2 : {1e-3, -1e-3}) {
    SpinTruth truth = usual_truth(HorizonModel::Ellipsoid);
    truth.motion.rate_drift_rad_s2 = drift_rad_s2;
    expect_the_oracles_edges(truth, kTransfer, 0.0, 120.0);
  }
}

TEST(SpinEdges, HaveNoSecondSunEdgeWhereTheSlitMissesTheSun) {
  SpinTruth truth = usual_truth(HorizonModel::Sphere);
  // The Sun is 6 deg from this body's equator: only a nearly level slit misses it.
  truth.sun_sensor.slit_cant_rad = 85.0 * kRadPerDeg;
  const auto edges = edges_of(truth, kTransfer, 10.0);
  EXPECT_EQ(std::ranges::count(edges, PulseChannel::Sun2, &TrueEdge::channel), 0);
  EXPECT_EQ(std::ranges::count(edges, PulseChannel::Sun1, &TrueEdge::channel), 10);
}

TEST(SpinEdges, DoNotDependOnTheSlices) {
  const SpinTruth truth = usual_truth(HorizonModel::Ellipsoid);
  const auto whole = edges_of(truth, kTransfer, 20.0);
  SpinEdges sliced{truth, kTransfer};
  std::vector<TrueEdge> joined;
  for (const double end_s : {0.1, 0.1, 3.7, 19.99, 20.0}) {
    const auto slice = sliced.until(end_s).value();
    joined.insert(joined.end(), slice.begin(), slice.end());
  }
  expect_same(joined, whole, 0.0);
  EXPECT_EQ(sliced.revolutions(), 20);
}

/// Returns how far the Sun is off the plane of the slit, or the beam off the limb of a spherical
/// Earth, at the time of the edge, rad.
double missed_rad(const SpinTruth& truth, const OrbitState& state, const TrueEdge& edge) {
  const Eigen::Vector3d& axis = truth.motion.axis_icrf;
  Eigen::Matrix3d R_icrf_axes;
  R_icrf_axes << tangent_basis(axis), axis;
  const Eigen::Matrix3d R_icrf_sensors =
      R_icrf_axes * truth.motion.R_axes_tipped(edge.t_s) *
      Eigen::AngleAxisd{truth.motion.azimuth_rad(edge.t_s), Eigen::Vector3d::UnitZ()};
  if (sees_the_sun(edge.channel)) {
    const Eigen::Vector3d sun = R_icrf_sensors.transpose() *
                                ApparentSun{}.direction_icrf(shifted(truth.start, edge.t_s), state);
    const bool first = edge.channel == PulseChannel::Sun1;
    const double behind_rad = first ? 0.0 : truth.sun_sensor.slit_separation_rad;
    const Eigen::Vector3d middle{std::cos(-behind_rad), std::sin(-behind_rad), 0.0};
    const Eigen::Vector3d north =
        Eigen::AngleAxisd{first ? 0.0 : truth.sun_sensor.slit_cant_rad, middle} *
        Eigen::Vector3d::UnitZ();
    return std::asin(sun.dot(middle.cross(north)));
  }
  const bool north =
      edge.channel == PulseChannel::NorthIn || edge.channel == PulseChannel::NorthOut;
  const TrueInfrared& sensor = north ? *truth.north : *truth.south;
  const Eigen::Vector3d beam{std::sin(sensor.mount_angle_rad) * std::cos(-sensor.azimuth_rad),
                             std::sin(sensor.mount_angle_rad) * std::sin(-sensor.azimuth_rad),
                             std::cos(sensor.mount_angle_rad)};
  const double disc_rad = std::asin(truth.horizon.equatorial_km / state.position_icrf_km.norm());
  return angle_between_rad(R_icrf_sensors * beam, -state.position_icrf_km) - disc_rad;
}

TEST(SpinEdges, OfABodyThatNutatesAndConesAreWhereItsSensorsMeetSunAndEarth) {
  for (const double inertia_ratio : {0.2, 0.9, 1.7}) {
    SCOPED_TRACE(inertia_ratio);
    SpinTruth truth = usual_truth(HorizonModel::Sphere);
    truth.motion.rate_drift_rad_s2 = 1e-4;
    truth.motion.nutation = {.half_angle_rad = 2.0 * kRadPerDeg,
                             .inertia_ratio = inertia_ratio,
                             .first_azimuth_rad = 1.0};
    truth.motion.coning = {.tilt_rad = 1.0 * kRadPerDeg, .azimuth_rad = 0.5};
    const auto edges = edges_of(truth, kTransfer, 60.0);
    std::array<int, kPulseChannels> count{};
    for (const TrueEdge& edge : edges) {
      ++count.at(index_of(edge.channel));
      const OrbitState state = kTransfer.at(shifted(truth.start, edge.t_s)).value();
      // The rotation in a nanosecond.
      EXPECT_LT(std::abs(missed_rad(truth, state, edge)), 7e-9) << name_of(edge.channel);
    }
    for (const int edges_of_channel : count) {
      EXPECT_NEAR(edges_of_channel, 60, 1);
    }
  }
}

TEST(SpinEdges, WidenAChordByItsExcessHalfAtEachEnd) {
  SpinTruth truth = usual_truth(HorizonModel::Sphere);
  const auto exact = edges_of(truth, kTransfer, 5.0);
  truth.north->chord_excess_rad = 0.2 * kRadPerDeg;
  const auto wide = edges_of(truth, kTransfer, 5.0);
  ASSERT_EQ(wide.size(), exact.size());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const PulseChannel channel = exact[i].channel;
    const double expected_deg = channel == PulseChannel::NorthIn    ? -0.1
                                : channel == PulseChannel::NorthOut ? 0.1
                                                                    : 0.0;
    // 6 deg per ms; the Earth moves by less than 1e-6 deg in that time.
    EXPECT_NEAR((wide[i].t_s - exact[i].t_s) * 360.0, expected_deg, 1e-5);
  }
}

TEST(SpinEdges, AreThoseOfTheOracleWhereverThePoleStands) {
  SpinTruth truth = usual_truth(HorizonModel::Ellipsoid);
  truth.horizon.pole_icrf = place(30.0, 50.0);
  expect_the_oracles_edges(truth, kTransfer, 0.0, 10.0);
}

Orbit interpolated(const std::vector<EphemerisPoint>& points, Interpolation by, int degree) {
  return Orbit{
      OrbitEphemeris::make({{points.front().t, points.back().t, by, degree, points}}).value()};
}

TEST(SpinEdges, EndWhereTheEarthHidesTheSun) {
  // The spacecraft is opposite to the Sun, 7000 km from the Earth's centre.
  ApparentSun sun;
  const Eigen::Vector3d away = -sun.direction_icrf(
      kStart, {.position_icrf_km = {7000.0, 0.0, 0.0}, .velocity_icrf_km_s = {0.0, 0.0, 0.0}});
  const Eigen::Vector3d along = away.cross(kIcrfPole).normalized();
  std::vector<EphemerisPoint> points;
  for (int i = -2; i <= 2; ++i) {
    points.push_back(
        {.t = shifted(kStart, 600.0 * i),
         .state = {.position_icrf_km = 7000.0 * away, .velocity_icrf_km_s = 1e-9 * along}});
  }
  const Orbit orbit = interpolated(points, Interpolation::Lagrange, 1);
  SpinEdges edges{truth_of(along, 60.0, HorizonModel::Sphere), orbit};
  const auto seen = edges.until(10.0).value();
  EXPECT_TRUE(std::ranges::none_of(seen, sees_the_sun, &TrueEdge::channel));
  EXPECT_GT(seen.size(), 30U);
  EXPECT_EQ(edges.revolutions(), 10);
}

TEST(SpinEdges, SayWhereTheOrbitEnds) {
  const std::vector<EphemerisPoint> points = {
      {.t = kStart,
       .state = {.position_icrf_km = {9000.0, 0.0, 0.0}, .velocity_icrf_km_s = {0.0, 7.0, 0.0}}},
      {.t = shifted(kStart, 5.0),
       .state = {.position_icrf_km = {9000.0, 35.0, 0.0}, .velocity_icrf_km_s = {0.0, 7.0, 0.0}}}};
  const Orbit orbit = interpolated(points, Interpolation::Hermite, 3);
  SpinEdges edges{usual_truth(HorizonModel::Sphere), orbit};
  EXPECT_THAT(edges.until(10.0), IsRefused(ErrorCode::NoCoverage, _));
}

/// Integrates the same motion of a torque-free body that is symmetric about its third axis.
BodyMotion integrated(const SpinMotion& motion, double end_s) {
  constexpr double kStep_s = 2.5e-3;
  const double ratio = motion.nutation.inertia_ratio;
  const double cosine = std::cos(motion.nutation.half_angle_rad);
  SpinMotion body = motion;
  body.coning = {};
  Eigen::Matrix3d R_icrf_axes;
  R_icrf_axes << tangent_basis(motion.axis_icrf), motion.axis_icrf;
  const Eigen::Matrix3d R_icrf_body =
      R_icrf_axes * body.R_axes_tipped(0.0) *
      Eigen::AngleAxisd{body.azimuth_rad(0.0), Eigen::Vector3d::UnitZ()};
  // The momentum gives the stated rate: spin_motion.h with 1 kg m2 across the axis.
  const double momentum_nms = motion.rate_rad_s / (1.0 + cosine / ratio - cosine);
  const Eigen::Vector3d inertia_kg_m2{1.0, 1.0, ratio};
  const Eigen::Vector3d rate_rad_s =
      (momentum_nms * R_icrf_body.transpose() * motion.axis_icrf).cwiseQuotient(inertia_kg_m2);
  BodyMotion free{RigidBody::make(Eigen::Matrix3d{inertia_kg_m2.asDiagonal()}).value(),
                  {.q_icrf_body = Eigen::Quaterniond{R_icrf_body}, .rate_body_rad_s = rate_rad_s},
                  kStep_s};
  while (free.end_s() < end_s) {
    free.step({});
  }
  return free;
}

SpinTruthOf<BodySpin> integrated(const SpinTruth& truth, double end_s) {
  const Coning& coning = truth.motion.coning;
  const Eigen::Vector3d hinge{std::sin(coning.azimuth_rad), std::cos(coning.azimuth_rad), 0.0};
  const Eigen::Quaterniond q_body_sensors{Eigen::AngleAxisd{coning.tilt_rad, hinge}};
  return {.start = truth.start,
          .motion = BodySpin::make(integrated(truth.motion, end_s), q_body_sensors).value(),
          .sun_sensor = truth.sun_sensor,
          .north = truth.north,
          .south = truth.south,
          .horizon = truth.horizon};
}

TEST(SpinEdges, OfAnIntegratedBodyAreThoseOfItsClosedForm) {
  constexpr double kEnd_s = 240.0;
  for (const double inertia_ratio : {0.3, 1.7}) {
    SCOPED_TRACE(inertia_ratio);
    SpinTruth truth = usual_truth(HorizonModel::Ellipsoid);
    truth.motion.nutation = {.half_angle_rad = 3.0 * kRadPerDeg,
                             .inertia_ratio = inertia_ratio,
                             .first_azimuth_rad = 1.0};
    truth.motion.coning = {.tilt_rad = 1.0 * kRadPerDeg, .azimuth_rad = 0.5};
    const auto expected = edges_of(truth, kTransfer, kEnd_s);
    const SpinTruthOf<BodySpin> free = integrated(truth, kEnd_s + 2.0);
    SpinEdges source{free, kTransfer};
    EXPECT_GT(expected.size(), 1400U);
    expect_same(source.until(kEnd_s).value(), expected, 1e-7);
    EXPECT_EQ(source.revolutions(), 240);
  }
}

TEST(SpinEdges, SayWhereTheMotionEnds) {
  const auto free = integrated(usual_truth(HorizonModel::Sphere), 5.0);
  SpinEdges edges{free, kTransfer};
  EXPECT_TRUE(edges.until(3.0));
  EXPECT_THAT(edges.until(10.0),
              IsRefused(ErrorCode::NoCoverage, HasSubstr("the motion of the body ends")));
}

TEST(BodySpin, RefusesABodyThatTumblesOrTurnsTooFastForItsSteps) {
  const auto error_of = [](const Eigen::Vector3d& rate_rad_s, double step_s) {
    BodyMotion tumbling{
        RigidBody::make(Eigen::Matrix3d{Eigen::Vector3d{1.0, 2.0, 2.5}.asDiagonal()}).value(),
        {.q_icrf_body = Eigen::Quaterniond::Identity(), .rate_body_rad_s = rate_rad_s},
        step_s};
    for (int i = 0; i < 2000; ++i) {
      tumbling.step({});
    }
    return BodySpin::make(tumbling, Eigen::Quaterniond::Identity()).error().message;
  };
  EXPECT_THAT(error_of({1.0, 0.0, 0.1}, 0.01), HasSubstr("must be below 90 deg"));
  EXPECT_THAT(error_of({0.0, 0.0, 6.0}, 0.05), HasSubstr("too coarse"));
}

}  // namespace spindrift::testing::spin_edges_test
