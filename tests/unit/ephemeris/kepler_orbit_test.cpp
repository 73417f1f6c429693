#include "pipelines/ephemeris/kepler_orbit.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::kepler_orbit_test {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr TaiTime kEpoch = tai_from_ns(1'795'143'637'000'000'000);

constexpr KeplerElements kTransfer{.epoch = kEpoch,
                                   .semi_major_axis_km = 24'400.0,
                                   .eccentricity = 0.72,
                                   .inclination_rad = 0.5,
                                   .raan_rad = 1.0,
                                   .argument_of_perigee_rad = 3.0,
                                   .mean_anomaly_rad = 0.25};

OrbitState state(const KeplerElements& elements, TaiTime t) {
  return KeplerOrbit::make(elements).value().at(t).value();
}

double period_s(double semi_major_axis_km) {
  return 2.0 * kPi * std::sqrt(std::pow(semi_major_axis_km, 3) / kEarthMu_km3_s2);
}

double mean_from_true_anomaly_rad(double true_rad, double e) {
  const double half_tangent = std::sqrt((1.0 - e) / (1.0 + e)) * std::tan(true_rad / 2.0);
  const double eccentric_rad = 2.0 * std::atan(half_tangent);
  return eccentric_rad - e * std::sin(eccentric_rad);
}

/// Returns elements of a random ellipse outside the Earth, e up to 0.99.
KeplerElements random_elements(std::mt19937& rng) {
  std::uniform_real_distribution<double> unit{0.0, 1.0};
  const double e = 0.99 * unit(rng);
  const double perigee_km = 6'500.0 + 10'000.0 * unit(rng);
  return {.epoch = kEpoch,
          .semi_major_axis_km = perigee_km / (1.0 - e),
          .eccentricity = e,
          .inclination_rad = kPi * unit(rng),
          .raan_rad = 2.0 * kPi * unit(rng),
          .argument_of_perigee_rad = 2.0 * kPi * unit(rng),
          .mean_anomaly_rad = 2.0 * kPi * unit(rng)};
}

TEST(KeplerOrbit, GivesTheStateOfVallado) {
  // Source: Vallado, Fundamentals of Astrodynamics and Applications, example 2-6. The elements have
  // five digits, so the state follows to about 0.1 km and 1e-4 km/s. Its perigee lies inside the
  // Earth; the orbit is therefore doubled, which doubles positions and divides velocities by
  // sqrt(2).
  constexpr double kEccentricity = 0.83285;
  constexpr double kScale = 2.0;
  const OrbitState at_epoch =
      state({.epoch = kEpoch,
             .semi_major_axis_km = kScale * 11'067.790 / (1.0 - kEccentricity * kEccentricity),
             .eccentricity = kEccentricity,
             .inclination_rad = 87.87 * kRadPerDeg,
             .raan_rad = 227.89 * kRadPerDeg,
             .argument_of_perigee_rad = 53.38 * kRadPerDeg,
             .mean_anomaly_rad = mean_from_true_anomaly_rad(92.335 * kRadPerDeg, kEccentricity)},
            kEpoch);
  const Eigen::Vector3d position_km{6525.344, 6861.535, 6449.125};
  const Eigen::Vector3d velocity_km_s{4.902276, 5.533124, -1.975709};
  EXPECT_LT((at_epoch.position_icrf_km / kScale - position_km).norm(), 0.1);
  EXPECT_LT((at_epoch.velocity_icrf_km_s * std::sqrt(kScale) - velocity_km_s).norm(), 1e-4);
}

TEST(KeplerOrbit, SolvesKeplersEquationAsVallado) {
  // Source: the same book, example 2-1: M = 235.4 deg and e = 0.4 give E = 220.512074767522 deg.
  KeplerElements elements = kTransfer;
  elements.eccentricity = 0.4;
  elements.mean_anomaly_rad = 235.4 * kRadPerDeg;
  const double radius_km =
      elements.semi_major_axis_km * (1.0 - 0.4 * std::cos(220.512074767522 * kRadPerDeg));
  EXPECT_NEAR(state(elements, kEpoch).position_icrf_km.norm(), radius_km, 1e-8);
}

TEST(KeplerOrbit, ApsidesAreWhereTheEllipseEnds) {
  KeplerElements elements = kTransfer;
  const double a_km = elements.semi_major_axis_km;
  const double e = elements.eccentricity;
  elements.mean_anomaly_rad = 0.0;
  const OrbitState perigee = state(elements, kEpoch);
  elements.mean_anomaly_rad = kPi;
  const OrbitState apogee = state(elements, kEpoch);
  EXPECT_NEAR(perigee.position_icrf_km.norm(), a_km * (1.0 - e), 1e-9);
  EXPECT_NEAR(apogee.position_icrf_km.norm(), a_km * (1.0 + e), 1e-9);
  EXPECT_NEAR(perigee.velocity_icrf_km_s.norm(),
              std::sqrt(kEarthMu_km3_s2 / a_km * (1.0 + e) / (1.0 - e)), 1e-12);
}

TEST(KeplerOrbit, PlaneIsThatOfItsNodeAndInclination) {
  const OrbitState at_epoch = state(kTransfer, kEpoch);
  const Eigen::Vector3d normal =
      at_epoch.position_icrf_km.cross(at_epoch.velocity_icrf_km_s).normalized();
  const Eigen::Vector3d expected{std::sin(0.5) * std::sin(1.0), -std::sin(0.5) * std::cos(1.0),
                                 std::cos(0.5)};
  EXPECT_LT((normal - expected).norm(), 1e-14);
}

TEST(KeplerOrbit, KeepsEnergyAndAngularMomentum) {
  std::mt19937 rng{27};
  std::uniform_real_distribution<double> day_s{-86'400.0, 86'400.0};
  for (int trial = 0; trial < 2000; ++trial) {
    const KeplerElements elements = random_elements(rng);
    const double a_km = elements.semi_major_axis_km;
    const double e = elements.eccentricity;
    SCOPED_TRACE(::testing::Message() << "trial " << trial << ", a " << a_km << " km, e " << e);
    const OrbitState now = state(elements, shifted(kEpoch, day_s(rng)));
    const double radius_km = now.position_icrf_km.norm();
    // The limit is relative to the kinetic term because both terms cancel near the perigee of a
    // long ellipse.
    const double kinetic = now.velocity_icrf_km_s.squaredNorm() / 2.0;
    const double energy = kinetic - kEarthMu_km3_s2 / radius_km;
    ASSERT_NEAR(energy, -kEarthMu_km3_s2 / (2.0 * a_km), 1e-13 * kEarthMu_km3_s2 / radius_km);
    const double momentum = now.position_icrf_km.cross(now.velocity_icrf_km_s).norm();
    const double expected = std::sqrt(kEarthMu_km3_s2 * a_km * (1.0 - e) * (1.0 + e));
    ASSERT_NEAR(momentum, expected, 1e-12 * radius_km * now.velocity_icrf_km_s.norm());
  }
}

TEST(KeplerOrbit, MeanAnomalyOfItsStateGrowsEvenly) {
  // E and M follow from the state: e cos E = 1 - r/a, e sin E = r.v / sqrt(mu a). Rounding (1e-15
  // of r/a and r.v) is divided by e when E is formed.
  std::mt19937 rng{1609};
  std::uniform_real_distribution<double> turns{-3.0, 3.0};
  for (int trial = 0; trial < 2000; ++trial) {
    const KeplerElements elements = random_elements(rng);
    const double a_km = elements.semi_major_axis_km;
    const TaiTime t = shifted(kEpoch, turns(rng) * period_s(a_km));
    const OrbitState now = state(elements, t);
    const double e_cos = 1.0 - now.position_icrf_km.norm() / a_km;
    const double e_sin =
        now.position_icrf_km.dot(now.velocity_icrf_km_s) / std::sqrt(kEarthMu_km3_s2 * a_km);
    const double mean_rad = std::atan2(e_sin, e_cos) - e_sin;
    const double expected_rad =
        elements.mean_anomaly_rad + 2.0 * kPi * seconds_between(kEpoch, t) / period_s(a_km);
    SCOPED_TRACE(::testing::Message() << "trial " << trial << ", e " << elements.eccentricity);
    ASSERT_NEAR(std::remainder(mean_rad - expected_rad, 2.0 * kPi), 0.0,
                1e-13 + 1e-14 / elements.eccentricity);
  }
}

TEST(KeplerOrbit, ReturnsAfterOnePeriod) {
  const double period = period_s(kTransfer.semi_major_axis_km);
  const OrbitState before = state(kTransfer, kEpoch);
  const OrbitState after = state(kTransfer, shifted(kEpoch, period));
  // Half a nanosecond of rounding at 10 km/s, and 1e-15 of a turn.
  EXPECT_LT((after.position_icrf_km - before.position_icrf_km).norm(), 1e-8);
  EXPECT_LT((after.velocity_icrf_km_s - before.velocity_icrf_km_s).norm(), 1e-11);
}

TEST(KeplerOrbit, VelocityIsTheSlopeOfPosition) {
  // The error of central differences is h^2/6 of the third derivative, below v n^2 (r_p/a)^-3 h^2 /
  // 6, plus rounding of positions, 1e-12 km / h.
  const KeplerOrbit orbit = KeplerOrbit::make(kTransfer).value();
  constexpr double kStep_s = 0.1;
  for (double t_s = 0.0; t_s < 40'000.0; t_s += 997.0) {
    const TaiTime t = shifted(kEpoch, t_s);
    const Eigen::Vector3d slope = (orbit.at(shifted(t, kStep_s)).value().position_icrf_km -
                                   orbit.at(shifted(t, -kStep_s)).value().position_icrf_km) /
                                  (2.0 * kStep_s);
    ASSERT_LT((slope - orbit.at(t).value().velocity_icrf_km_s).norm(), 1e-7) << t_s;
  }
}

TEST(KeplerOrbit, CircleKeepsItsRadius) {
  KeplerElements elements = kTransfer;
  elements.eccentricity = 0.0;
  for (double t_s = 0.0; t_s < 100'000.0; t_s += 3'331.0) {
    EXPECT_NEAR(state(elements, shifted(kEpoch, t_s)).position_icrf_km.norm(),
                elements.semi_major_axis_km, 1e-10);
  }
}

TEST(KeplerOrbit, ThroughOneOfItsStatesItIsTheSame) {
  KeplerElements circle = kTransfer;
  circle.eccentricity = 0.0;
  KeplerElements equatorial = kTransfer;
  equatorial.inclination_rad = 0.0;
  for (const KeplerElements& elements : {kTransfer, circle, equatorial}) {
    for (double from_s = 0.0; from_s < 40'000.0; from_s += 3'331.0) {
      const TaiTime from = shifted(kEpoch, from_s);
      const auto orbit = KeplerOrbit::through(from, state(elements, from)).value();
      for (const double after_s : {0.0, 500.0, -9'000.0, 30'000.0}) {
        const OrbitState there = orbit.at(shifted(from, after_s)).value();
        const OrbitState expected = state(elements, shifted(from, after_s));
        EXPECT_NEAR((there.position_icrf_km - expected.position_icrf_km).norm(), 0.0, 1e-5);
        EXPECT_NEAR((there.velocity_icrf_km_s - expected.velocity_icrf_km_s).norm(), 0.0, 1e-8);
      }
    }
  }
}

TEST(KeplerOrbit, GoesThroughNoStateOnNoEllipse) {
  const auto through = [](const Eigen::Vector3d& position_km,
                          const Eigen::Vector3d& velocity_km_s) {
    return KeplerOrbit::through(kEpoch, {position_km, velocity_km_s});
  };
  for (const auto& orbit :
       {through({7000.0, 0.0, 0.0}, {0.0, 11.0, 0.0}), through({7000.0, 0.0, 0.0}, {0.0, 5.0, 0.0}),
        through({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), through({7000.0, 0.0, 0.0}, {kNaN, 7.0, 0.0})}) {
    EXPECT_THAT(orbit, IsRefused(ErrorCode::InvalidInput, HasSubstr("no ellipse")));
  }
}

TEST(KeplerOrbit, RefusesWhatIsNoOrbit) {
  const auto with = [](auto change) {
    KeplerElements elements = kTransfer;
    change(elements);
    return elements;
  };
  const std::vector<std::pair<KeplerElements, std::string>> cases = {
      {with([](auto& k) { k.eccentricity = 1.0; }), "eccentricity 1"},
      {with([](auto& k) { k.eccentricity = -0.1; }), "eccentricity -0.1"},
      {with([](auto& k) { k.eccentricity = kNaN; }), "eccentricity nan"},
      {with([](auto& k) { k.eccentricity = 0.8; }), "4880.000 km"},
      {with([](auto& k) { k.semi_major_axis_km = -24'400.0; }), "-24400 km"},
      {with([](auto& k) { k.semi_major_axis_km = kNaN; }), "nan km"},
      {with([](auto& k) { k.semi_major_axis_km = std::numeric_limits<double>::infinity(); }),
       "inf km"},
      {with([](auto& k) { k.inclination_rad = 3.2; }), "inclination 3.2"},
      {with([](auto& k) { k.inclination_rad = kNaN; }), "inclination nan"},
      {with([](auto& k) { k.raan_rad = kNaN; }), "node"},
      {with([](auto& k) { k.argument_of_perigee_rad = kNaN; }), "argument of perigee"},
      {with([](auto& k) { k.mean_anomaly_rad = kNaN; }), "mean anomaly"},
  };
  for (const auto& [elements, reason] : cases) {
    SCOPED_TRACE(reason);
    EXPECT_THAT(KeplerOrbit::make(elements),
                IsRefused(ErrorCode::InvalidConfiguration, HasSubstr(reason)));
  }
}

}  // namespace spindrift::kepler_orbit_test
