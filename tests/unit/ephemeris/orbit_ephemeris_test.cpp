#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/oem.h"
#include "tests/support/matchers.h"

namespace spindrift::orbit_ephemeris_test {

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

/// Holds a vector of polynomials of one degree about kStart, with derivative. Time is in minutes to
/// keep the powers of order one.
struct PolynomialOrbit {
  std::vector<Eigen::Vector3d> coefficients_km;

  OrbitState at(TaiTime t) const {
    const double u = seconds_between(kStart, t) / 60.0;
    OrbitState state{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t k = coefficients_km.size(); k-- > 0;) {
      state.velocity_icrf_km_s = state.position_icrf_km + u * state.velocity_icrf_km_s;
      state.position_icrf_km = coefficients_km[k] + u * state.position_icrf_km;
    }
    state.velocity_icrf_km_s /= 60.0;
    return state;
  }
};

PolynomialOrbit random_polynomial(std::mt19937& rng, int degree) {
  std::uniform_real_distribution<double> any_km{-7'000.0, 7'000.0};
  PolynomialOrbit orbit;
  for (int k = 0; k <= degree; ++k) {
    const double x = any_km(rng);
    const double y = any_km(rng);
    orbit.coefficients_km.push_back(Eigen::Vector3d{x, y, any_km(rng)} / std::pow(4.0, k));
  }
  return orbit;
}

template <class Source>
OemSegment sampled(const Source& orbit, TaiTime from, double step_s, int count,
                   Interpolation interpolation, int degree) {
  std::vector<EphemerisPoint> points;
  for (int i = 0; i < count; ++i) {
    const TaiTime t = shifted(from, i * step_s);
    points.push_back({t, orbit(t)});
  }
  const TaiTime first = points.front().t;
  const TaiTime last = points.back().t;
  return {first, last, interpolation, degree, std::move(points)};
}

OrbitEphemeris ephemeris_of(OemSegment segment) {
  std::vector<OemSegment> segments;
  segments.push_back(std::move(segment));
  return OrbitEphemeris::make(std::move(segments)).value();
}

const KeplerOrbit kTransfer = KeplerOrbit::make({.epoch = kStart,
                                                 .semi_major_axis_km = 24'400.0,
                                                 .eccentricity = 0.7,
                                                 .inclination_rad = 0.5,
                                                 .raan_rad = 1.0,
                                                 .argument_of_perigee_rad = 3.0,
                                                 .mean_anomaly_rad = 0.2})
                                  .value();

OemSegment of_transfer(TaiTime from, double step_s, int count, Interpolation interpolation,
                       int degree) {
  return sampled([](TaiTime t) { return kTransfer.at(t).value(); }, from, step_s, count,
                 interpolation, degree);
}

/// Checks polynomials with nodes and times within 4 minutes of kStart.
void expect_polynomials_reproduced(std::mt19937& rng, Interpolation interpolation, int degree,
                                   double step_s, int nodes) {
  SCOPED_TRACE(degree);
  std::uniform_real_distribution<double> within_s{-240.0, 240.0};
  const PolynomialOrbit orbit = random_polynomial(rng, degree);
  const OrbitEphemeris ephemeris =
      ephemeris_of(sampled([&](TaiTime t) { return orbit.at(t); }, shifted(kStart, -240.0), step_s,
                           nodes, interpolation, degree));
  for (int trial = 0; trial < 100; ++trial) {
    const TaiTime t = shifted(kStart, within_s(rng));
    const OrbitState state = ephemeris.at(t).value();
    // The terms are of order 7000 km times (4/4)^k with rounding of 1e-12 km each, which divided
    // differences over few uneven nodes increase to below 1e-8 km.
    ASSERT_LT((state.position_icrf_km - orbit.at(t).position_icrf_km).norm(), 1e-8);
    ASSERT_LT((state.velocity_icrf_km_s - orbit.at(t).velocity_icrf_km_s).norm(), 1e-9);
  }
}

TEST(OrbitEphemeris, LagrangeReproducesPolynomialsOfItsDegree) {
  std::mt19937 rng{1};
  for (int degree = 1; degree <= 9; ++degree) {
    expect_polynomials_reproduced(rng, Interpolation::Lagrange, degree, 40.0, 13);
  }
}

TEST(OrbitEphemeris, HermiteReproducesPolynomialsOfItsDegree) {
  std::mt19937 rng{2};
  for (const int degree : {3, 5, 7, 9}) {
    expect_polynomials_reproduced(rng, Interpolation::Hermite, degree, 60.0, 9);
  }
}

TEST(OrbitEphemeris, PassesThroughItsNodes) {
  for (const auto interpolation : {Interpolation::Lagrange, Interpolation::Hermite}) {
    for (int degree = 1; degree <= kMaxInterpolationDegree; ++degree) {
      SCOPED_TRACE(degree);
      const OemSegment segment = of_transfer(kStart, 60.0, 40, interpolation, degree);
      const OrbitEphemeris ephemeris = ephemeris_of(segment);
      for (const EphemerisPoint& point : segment.points) {
        const OrbitState state = ephemeris.at(point.t).value();
        ASSERT_LT((state.position_icrf_km - point.state.position_icrf_km).norm(), 1e-8);
        ASSERT_LT((state.velocity_icrf_km_s - point.state.velocity_icrf_km_s).norm(), 1e-9);
      }
    }
  }
}

TEST(OrbitEphemeris, IsContinuousWhereTheWindowMoves) {
  // 1 ns of motion is 1e-8 km. With Hermite the velocity is also continuous; degree 3 at 10 minutes
  // is too inaccurate (kilometres) to hide a jump.
  for (const auto interpolation : {Interpolation::Lagrange, Interpolation::Hermite}) {
    const OemSegment segment = of_transfer(kStart, 600.0, 12, interpolation, 3);
    const OrbitEphemeris ephemeris = ephemeris_of(segment);
    for (std::size_t i = 1; i + 1 < segment.points.size(); ++i) {
      const TaiTime node = segment.points[i].t;
      const OrbitState before = ephemeris.at(node - std::chrono::nanoseconds{1}).value();
      const OrbitState after = ephemeris.at(node).value();
      ASSERT_LT((after.position_icrf_km - before.position_icrf_km).norm(), 2e-8);
      ASSERT_LT((after.velocity_icrf_km_s - before.velocity_icrf_km_s).norm(), 1e-10);
    }
  }
}

/// Expects the interpolation of a circular orbit to be off by 0.9 to 1.0 of its bound, between the
/// nodes `first` and `last`.
void expect_bound(Interpolation interpolation, int degree, double step_s, int nodes, int first,
                  int last, double bound_of_derivative) {
  const KeplerOrbit circle = KeplerOrbit::make({kStart, 7'000.0, 0.0, 0.9, 0.1, 0.0, 0.0}).value();
  const double n_rad_s = std::sqrt(kEarthMu_km3_s2 / std::pow(7'000.0, 3));
  const double bound_km = bound_of_derivative * 7'000.0 * std::pow(step_s * n_rad_s, degree + 1);
  const OrbitEphemeris ephemeris =
      ephemeris_of(sampled([&](TaiTime t) { return circle.at(t).value(); }, kStart, step_s, nodes,
                           interpolation, degree));
  double worst_km = 0.0;
  for (double t_s = first * step_s; t_s < last * step_s; t_s += 7.3) {
    const TaiTime t = shifted(kStart, t_s);
    worst_km = std::max(
        worst_km,
        (ephemeris.at(t).value().position_icrf_km - circle.at(t).value().position_icrf_km).norm());
  }
  EXPECT_LT(worst_km, bound_km);
  EXPECT_GT(worst_km, 0.9 * bound_km);
}

TEST(OrbitEphemeris, KeepsItsBoundOnAKeplerOrbit) {
  // |error| <= h^4/384 max|r^(4)|, which on this circle is exactly a n^4.
  expect_bound(Interpolation::Hermite, 3, 60.0, 100, 0, 99, 1.0 / 384.0);
  // With degree 7 in the middle of 8 nodes the error is at most |prod (t - t_k)| / 8! max|r^(8)|;
  // the product is largest half way, (1/2 3/2 5/2 7/2)^2 h^8.
  expect_bound(Interpolation::Lagrange, 7, 180.0, 40, 4, 35, std::pow(105.0 / 16.0, 2) / 40'320.0);
}

TEST(OrbitEphemeris, AnswersOnlyWhereItIsUsable) {
  OemSegment first = of_transfer(kStart, 60.0, 10, Interpolation::Hermite, 3);
  OemSegment second = of_transfer(shifted(kStart, 600.0), 60.0, 10, Interpolation::Lagrange, 4);
  first.usable_from = shifted(kStart, 30.0);
  std::vector<OemSegment> segments{first, second};
  const OrbitEphemeris ephemeris = OrbitEphemeris::make(segments).value();
  EXPECT_EQ(ephemeris.usable_from(), shifted(kStart, 30.0));
  EXPECT_EQ(ephemeris.usable_to(), shifted(kStart, 1140.0));
  const std::vector<std::pair<double, std::string>> outside = {
      {17.5, "12.5 s before"},
      {541.0, "1 s after one segment ends and 59 s before the next"},
      {1140.25, "0.25 s after"},
  };
  for (const auto& [t_s, where] : outside) {
    EXPECT_THAT(ephemeris.at(shifted(kStart, t_s)),
                IsRefused(ErrorCode::NoCoverage, HasSubstr(where)));
  }
  for (const double t_s : {30.0, 540.0, 600.0, 1140.0}) {
    EXPECT_TRUE(ephemeris.at(shifted(kStart, t_s))) << t_s;
  }
}

TEST(OrbitEphemeris, LaterSegmentAnswersWhereTwoTouch) {
  // At a manoeuvre the position is continuous and the velocity changes.
  const auto still = [](double speed_km_s) {
    return [speed_km_s](TaiTime t) {
      return OrbitState{{7'000.0, speed_km_s * seconds_between(shifted(kStart, 60.0), t), 0.0},
                        {0.0, speed_km_s, 0.0}};
    };
  };
  const OrbitEphemeris ephemeris =
      OrbitEphemeris::make(
          {sampled(still(7.0), kStart, 30.0, 3, Interpolation::Hermite, 3),
           sampled(still(8.0), shifted(kStart, 60.0), 30.0, 3, Interpolation::Hermite, 3)})
          .value();
  const auto speed_at = [&](double t_s) {
    return ephemeris.at(shifted(kStart, t_s)).value().velocity_icrf_km_s.y();
  };
  EXPECT_NEAR(speed_at(59.999), 7.0, 1e-12);
  EXPECT_NEAR(speed_at(60.0), 8.0, 1e-12);
}

TEST(OrbitEphemeris, RefusesSegmentsThatCannotBeInterpolated) {
  const OemSegment good = of_transfer(kStart, 60.0, 4, Interpolation::Lagrange, 3);
  const auto refusal = [](std::vector<OemSegment> segments) {
    const auto ephemeris = OrbitEphemeris::make(std::move(segments));
    return ephemeris ? "accepted" : ephemeris.error().message;
  };
  EXPECT_EQ(refusal({good}), "accepted");
  EXPECT_THAT(refusal({}), HasSubstr("no segment"));
  OemSegment segment = good;
  segment.degree = 4;
  EXPECT_THAT(refusal({good, segment}),
              AllOf(HasSubstr("segment 2"), HasSubstr("needs 5 data lines, there are 4")));
  segment.degree = 0;
  EXPECT_THAT(refusal({segment}), HasSubstr("INTERPOLATION_DEGREE = 0: must lie in 1 to 15"));
  segment = good;
  segment.points[2].t = segment.points[1].t;
  EXPECT_THAT(refusal({segment}), HasSubstr("must be later"));
  segment = good;
  segment.usable_to = shifted(kStart, 181.0);
  EXPECT_THAT(refusal({segment}), HasSubstr("within the data lines"));
  EXPECT_THAT(refusal({good, good}), HasSubstr("must not begin before"));
}

}  // namespace spindrift::orbit_ephemeris_test
