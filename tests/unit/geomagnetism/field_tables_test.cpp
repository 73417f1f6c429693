/// Tables of the field along a revolution: closed forms, and the figures of the paper's orbit.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/tables/curvature_knots.h"
#include "pipelines/geomagnetism/tables/field_table.h"
#include "pipelines/geomagnetism/tables/revolution_field.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::field_tables_test {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kEarthRate_rad_s = 7.292115e-5;

KeplerElements circular() {
  return {.epoch = TaiTime{std::chrono::days{14'610}},
          .semi_major_axis_km = kFieldRadius_km + 650.0,
          .eccentricity = 0.0,
          .inclination_rad = 97.0 * kRadPerDeg,
          .raan_rad = 10.0 * kRadPerDeg,
          .argument_of_perigee_rad = 0.0,
          .mean_anomaly_rad = 0.0};
}

/// Returns the field of Liu 2019: degree 10 in 2010, a circular orbit of 650 km, the Greenwich
/// angle 0 at the start, a sample each second of 5,875. The two ends are 5,874 s apart.
FieldAlong paper_field() {
  const MainField field = igrf().value().at(2010.0, 10).value();
  const KeplerOrbit orbit = KeplerOrbit::make(circular()).value();
  return [=](double behind_rad) {
    const double t_s = behind_rad / kTurn_rad * (kRevolutionSamples - 1);
    const Eigen::Quaterniond q_icrf_itrf{
        Eigen::AngleAxisd{kEarthRate_rad_s * t_s, Vector3d::UnitZ()}};
    return field_orbit_nt(field, orbit.at(shifted(circular().epoch, t_s)).value(), q_icrf_itrf);
  };
}

/// Returns the field of one axis alone, for which the paper chooses the knots.
FieldAlong axis_of(const FieldAlong& field, Eigen::Index axis) {
  return [=](double behind_rad) {
    return field(behind_rad).map([&](const Vector3d& field_nt) -> Vector3d {
      return field_nt[axis] * Vector3d::Unit(axis);
    });
  };
}

FieldTable table_of(const FieldAlong& field, TableKind kind, int points) {
  return make_table(field, kind, 0.0, points).value();
}

void expect_within_5_percent(const Vector3d& measured_nt, const Vector3d& published_nt) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(measured_nt[axis], published_nt[axis], 0.05 * published_nt[axis]) << axis;
  }
}

TEST(FieldTablesOfThePaper, EqualStepsHaveTheirErrors) {
  const FieldAlong field = paper_field();
  const FieldTable table = table_of(field, TableKind::Uniform, 80);
  EXPECT_EQ(table.bytes(), 968U);
  expect_within_5_percent(errors_of(table, sampled(field).value()).mean_nt, {16.9, 2.7, 25.5});
}

TEST(FieldTablesOfThePaper, KnotsByCurvatureHaveTheirErrors) {
  Vector3d mean_nt;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const FieldAlong field = axis_of(paper_field(), axis);
    mean_nt[axis] =
        errors_of(table_of(field, TableKind::Curvature, 80), sampled(field).value()).mean_nt[axis];
  }
  expect_within_5_percent(mean_nt, {13.2, 2.2, 22.2});
}

TEST(FieldTablesOfThePaper, ChebyshevCoefficientsHaveTheirErrors) {
  const FieldAlong field = paper_field();
  const SampledField truth_nt = sampled(field).value();
  const FieldTable coarse = table_of(field, TableKind::Chebyshev, 26);
  EXPECT_EQ(coarse.bytes(), 320U);
  expect_within_5_percent(errors_of(coarse, truth_nt).mean_nt, {8.9, 1.4, 9.9});
  const TableErrors fine = errors_of(table_of(field, TableKind::Chebyshev, 80), truth_nt);
  EXPECT_LT(fine.mean_nt.maxCoeff(), 0.01);
}

RevolutionField revolution(double eccentricity) {
  KeplerElements elements = circular();
  elements.semi_major_axis_km = 7'900.0;
  elements.eccentricity = eccentricity;
  elements.mean_anomaly_rad = 2.0;
  return {KeplerOrbit::make(elements).value(), igrf().value().at(2026.5).value()};
}

class OfARevolution : public ::testing::TestWithParam<double> {
 protected:
  RevolutionField along_ = revolution(GetParam());
  FieldAlong field_ = [this](double behind_rad) { return along_.at(behind_rad); };
  SampledField truth_nt_ = sampled(field_).value();

  TableErrors errors(TableKind kind, int points) {
    return errors_of(table_of(field_, kind, points), truth_nt_);
  }
};
INSTANTIATE_TEST_SUITE_P(Eccentricity, OfARevolution, ::testing::Values(0.0, 0.1));

TEST_P(OfARevolution, KnotsByCurvatureBeatEqualSteps) {
  for (const int points : {20, 40, 80, 160}) {
    EXPECT_LT(errors(TableKind::Curvature, points).mean_nt.sum(),
              errors(TableKind::Uniform, points).mean_nt.sum())
        << points;
  }
}

TEST_P(OfARevolution, TablesHold) {
  EXPECT_LT(errors(TableKind::Uniform, 80).mean_nt.maxCoeff(), 30.0);
  EXPECT_LT(errors(TableKind::Chebyshev, 79).mean_nt.maxCoeff(), 0.01);
}

TEST_P(OfARevolution, ChebyshevHoldsWithAnyNumberOfCoefficients) {
  for (const int coefficients : {150, 151, 5'000, 20'000}) {
    const FieldTable table = table_of(field_, TableKind::Chebyshev, coefficients);
    EXPECT_EQ(std::ssize(table.rows), coefficients);
    for (Eigen::Index i = 0; i < truth_nt_.cols(); i += 97) {
      const double behind_rad = kTurn_rad * static_cast<double>(i) / (kRevolutionSamples - 1);
      EXPECT_LT((lookup(table, behind_rad) - truth_nt_.col(i)).norm(), 0.01) << coefficients;
    }
  }
}

TEST(FieldTable, OfManyChebyshevCoefficientsHoldsAKink) {
  const FieldAlong kink = [](double rad) -> Expected<Vector3d> {
    return Vector3d{1000.0 * std::abs(rad - 2.0), 0.0, 0.0};
  };
  const FieldTable table = table_of(kink, TableKind::Chebyshev, 100'000);
  for (const double rad : {0.0, 1.0, 1.999, 2.0, 2.5, kTurn_rad}) {
    EXPECT_LT((lookup(table, rad) - *kink(rad)).norm(), 0.1) << rad;
  }
}

TEST(FieldTablesOfThePaper, ChebyshevOf312BytesBeatsTablesOf968UnderTheEarthAsItTurns) {
  RevolutionField along{KeplerOrbit::make(circular()).value(),
                        igrf().value().at(2010.0, 10).value()};
  const FieldAlong field = [&](double behind_rad) { return along.at(behind_rad); };
  const SampledField truth_nt = sampled(field).value();
  const Vector3d small_nt = errors_of(table_of(field, TableKind::Chebyshev, 26), truth_nt).mean_nt;
  for (const TableKind kind : {TableKind::Uniform, TableKind::Curvature}) {
    const Vector3d large_nt = errors_of(table_of(field, kind, 80), truth_nt).mean_nt;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_LT(small_nt[axis], 0.7 * large_nt[axis]) << name_of(kind) << axis;
    }
  }
}

struct LowOrbit {
  double height_km;
  double inclination_deg;
};

/// Mean errors, all axes together, over nodes all around the Earth; nT.
class OnLowOrbits : public ::testing::TestWithParam<LowOrbit> {};
INSTANTIATE_TEST_SUITE_P(Each, OnLowOrbits,
                         ::testing::Values(LowOrbit{650.0, 97.0}, LowOrbit{650.0, 28.5},
                                           LowOrbit{1000.0, 51.6}));

TEST_P(OnLowOrbits, ChebyshevOf312BytesBeatsTablesOf968OnAverageAndOf368OnEach) {
  const MainField main_field = igrf().value().at(2026.2).value();
  double of_312_nt = 0.0;
  double of_968_nt = 0.0;
  for (int node = 0; node < 12; ++node) {
    KeplerElements elements = circular();
    elements.semi_major_axis_km = kFieldRadius_km + GetParam().height_km;
    elements.inclination_rad = GetParam().inclination_deg * kRadPerDeg;
    elements.raan_rad = kTurn_rad * node / 12;
    RevolutionField along{KeplerOrbit::make(elements).value(), main_field};
    const FieldAlong field = [&](double behind_rad) { return along.at(behind_rad); };
    const SampledField truth_nt = sampled(field).value();
    const auto mean_nt = [&](TableKind kind, int points) {
      return errors_of(table_of(field, kind, points), truth_nt).mean_nt.sum();
    };
    const double best_nt =
        std::min(mean_nt(TableKind::Uniform, 80), mean_nt(TableKind::Curvature, 80));
    EXPECT_LT(mean_nt(TableKind::Chebyshev, 30), best_nt) << node;
    of_312_nt += mean_nt(TableKind::Chebyshev, 26);
    of_968_nt += best_nt;
  }
  EXPECT_LT(of_312_nt, of_968_nt);
}

TEST(FieldTable, OfEqualStepsGivesALineExactly) {
  const FieldAlong line = [](double rad) -> Expected<Vector3d> {
    return Vector3d{rad, 2.0 - rad, 0.5 * rad};
  };
  const FieldTable table = table_of(line, TableKind::Uniform, 7);
  for (const double rad : {0.0, 0.3, std::numbers::pi, 6.0, kTurn_rad}) {
    EXPECT_LT((lookup(table, rad) - *line(rad)).norm(), 1e-6) << rad;
  }
}

TEST(FieldTable, OfChebyshevGivesAPolynomialExactly) {
  const FieldAlong cubic = [](double rad) -> Expected<Vector3d> {
    const double x = rad / std::numbers::pi - 1.0;
    return Vector3d{4.0 * x * x * x - 3.0 * x, x * x, 1.0};
  };
  const FieldTable table = table_of(cubic, TableKind::Chebyshev, 4);
  EXPECT_LT((table.rows[3].cast<double>() - Vector3d{1.0, 0.0, 0.0}).norm(), 1e-7);
  EXPECT_LT((table.rows[2].cast<double>() - Vector3d{0.0, 0.5, 0.0}).norm(), 1e-7);
  EXPECT_LT((lookup(table, 1.0) - *cubic(1.0)).norm(), 1e-6);
}

TEST(FieldTable, HasFewestAndMostPoints) {
  const FieldAlong none = [](double) -> Expected<Vector3d> { return Vector3d{1.0, 0.0, 0.0}; };
  for (const int points : {-1, 0, 3, 100'001}) {
    EXPECT_THAT(make_table(none, TableKind::Uniform, 0.0, points),
                IsRefused(ErrorCode::InvalidInput, HasSubstr("must be 4 to 100000")));
  }
  EXPECT_THAT(make_table(none, TableKind::Chebyshev, 0.0, 100'001),
              IsRefused(ErrorCode::InvalidInput, HasSubstr("must be 4 to 100000")));
  EXPECT_EQ(table_of(none, TableKind::Uniform, 4).rows.size(), 4U);
}

TEST(CurvatureKnots, StandAtEqualStepsWhereAllBendsAlike) {
  const std::vector<double> places = knots_by_curvature(std::vector<double>(101, 0.3), 1.0, 5);
  const std::vector<double> equal{0.0, 0.25, 0.5, 0.75, 1.0};
  for (std::size_t i = 0; i < equal.size(); ++i) {
    EXPECT_NEAR(places.at(i), equal[i], 1e-12);
  }
}

TEST(CurvatureKnots, ApproachEqualStepsAsTheirWeightGrows) {
  const SampledField field_nt = sampled(paper_field()).value();
  const std::vector<double> places = knots_by_curvature(chord_curvature(field_nt), 1e6, 80);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(places[i], static_cast<double>(i) / 79.0, 1e-4);
  }
}

TEST(CurvatureKnots, ChordOfACircleHasItsCurvature) {
  // A parabola of curvature c has the chord curvature c U / 2 at its vertex.
  const SampledField parabola = sampled([](double rad) -> Expected<Vector3d> {
                                  const double x = rad - std::numbers::pi;
                                  return Vector3d{0.5 * x * x, 0.0, 0.0};
                                }).value();
  const double curvature = 1.0 / parabola.row(0).maxCoeff();
  EXPECT_NEAR(chord_curvature(parabola)[kRevolutionSamples / 2], 0.5 * 0.05 * curvature,
              1e-2 * curvature * 0.05);
}

TEST(KeplerOrbit, ReachesATrueAnomalyWhenItsStateIsThere) {
  KeplerElements elements = circular();
  elements.semi_major_axis_km = 9'000.0;
  elements.eccentricity = 0.1;
  elements.mean_anomaly_rad = 4.0;
  const KeplerOrbit orbit = KeplerOrbit::make(elements).value();
  const Vector3d first_km = orbit.at(elements.epoch).value().position_icrf_km;
  for (const double behind_rad : {0.5, 3.0, 5.0}) {
    const Vector3d there_km =
        orbit.at(orbit.when_behind_epoch(behind_rad)).value().position_icrf_km;
    EXPECT_NEAR(std::acos(first_km.normalized().dot(there_km.normalized())),
                std::min(behind_rad, kTurn_rad - behind_rad), 1e-7);
  }
  for (const double behind_rad : {-9.0, 0.0, 0.5, 3.0, 5.0, kTurn_rad, 9.0, 20.0}) {
    EXPECT_NEAR(orbit.true_anomaly_behind_epoch_rad(orbit.when_behind_epoch(behind_rad)),
                behind_rad, 1e-9);
  }
  EXPECT_EQ(orbit.true_anomaly_behind_epoch_rad(elements.epoch), 0.0);
  const double period_s = kTurn_rad / orbit.mean_motion_rad_s();
  EXPECT_NEAR(seconds_between(elements.epoch, orbit.when_behind_epoch(kTurn_rad)), period_s, 1e-6);
}

}  // namespace spindrift::testing::field_tables_test
