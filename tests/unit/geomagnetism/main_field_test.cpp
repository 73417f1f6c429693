#include "pipelines/geomagnetism/main_field.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "pipelines/frames/angle.h"
#include "services/mission/igrf.h"
#include "tests/support/matchers.h"

namespace spindrift::main_field_test {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

MainField field_of(double year, int degree = kHighestDegree) {
  return igrf().value().at(year, degree).value();
}

Vector3d geocentric_nt(const MainField& field, double latitude_deg, double longitude_deg,
                       double radius_km) {
  const GeocentricPlace place{.latitude_rad = latitude_deg * kRadPerDeg,
                              .longitude_rad = longitude_deg * kRadPerDeg,
                              .radius_km = radius_km};
  return field.ned_at(local_frame(place).value()).value();
}

struct Published {
  double year;
  double colatitude_deg;
  double longitude_deg;
  double radius_km;
  double north_nt;
  double east_nt;
  double down_nt;
};

void expect_published(const Published& is) {
  SCOPED_TRACE(is.year);
  constexpr double kPrinted_nt = 0.011;  // The reference values have two decimals.
  const Vector3d field_nt =
      geocentric_nt(field_of(is.year), 90.0 - is.colatitude_deg, is.longitude_deg, is.radius_km);
  EXPECT_NEAR(field_nt.x(), is.north_nt, kPrinted_nt);
  EXPECT_NEAR(field_nt.y(), is.east_nt, kPrinted_nt);
  EXPECT_NEAR(field_nt.z(), is.down_nt, kPrinted_nt);
}

TEST(MainField, IsThatPublishedByTheBritishGeologicalSurvey) {
  // Source: IGRF-14 with the program pyIGRF (tests/tests_igrf14.py).
  for (const Published& is : {
           Published{1900.0, 175.0, -150.0, 6300.0, -5072.93, 10620.34, -67233.55},
           Published{1915.0, 155.0, -120.0, 6350.0, 14692.62, 12387.97, -59640.81},
           Published{1930.0, 135.0, -90.0, 6400.0, 23925.47, 10358.94, -30640.98},
           Published{1945.0, 115.0, -60.0, 6450.0, 23642.86, -200.29, -7607.92},
           Published{1960.0, 95.0, -30.0, 6500.0, 23647.00, -9302.27, -3610.73},
           Published{1975.0, 75.0, 0.0, 6550.0, 30050.59, -3367.82, 6332.69},
           Published{1990.0, 55.0, 30.0, 6600.0, 25224.81, 1058.25, 30965.61},
           Published{2005.0, 35.0, 60.0, 6650.0, 14718.37, 2842.99, 46050.88},
           Published{2010.0, 170.0, 0.0, 6371.0, 17529.48, -7143.78, -42722.46},
           Published{2020.0, 15.0, 90.0, 6700.0, 3734.07, 1294.17, 50833.13},
           Published{2025.0, 56.0, -3.0, 6375.0, 28927.56, 261.98, 30910.08},
           Published{2030.0, 45.0, -5.0, 6375.0, 22959.82, 224.80, 40764.14},
       }) {
    expect_published(is);
  }
}

TEST(MainField, IsThatOfAnotherSynthesisBetweenEpochs) {
  expect_published({2022.5, 60.0, 120.0, 6878.137, 26371.527, -2215.549, 26745.773});
  expect_published({2027.5, 60.0, 120.0, 6878.137, 26340.532, -2310.716, 26938.489});
}

TEST(MainField, OfDegreeOneIsADipole) {
  GaussCoefficients coefficients;
  coefficients.g_nt.at(GaussCoefficients::index(1, 0)) = -29000.0;
  coefficients.g_nt.at(GaussCoefficients::index(1, 1)) = -1400.0;
  coefficients.h_nt.at(GaussCoefficients::index(1, 1)) = 4600.0;
  const Vector3d moment_nt{-1400.0, 4600.0, -29000.0};
  const Vector3d position_km{3000.0, -5000.0, 4500.0};
  const Vector3d to = position_km.normalized();
  const double ratio = kFieldRadius_km / position_km.norm();
  const Vector3d expected_nt = ratio * ratio * ratio * (3.0 * moment_nt.dot(to) * to - moment_nt);
  const MainField dipole{coefficients, 1};
  EXPECT_NEAR((dipole.at(position_km).value() - expected_nt).norm(), 0.0, 1e-10);
}

TEST(MainField, IsSummedNoFurtherThanItsDegree) {
  GaussCoefficients coefficients;
  GaussCoefficients lower;
  for (std::size_t i = 1; i < GaussCoefficients::kCount; ++i) {
    coefficients.g_nt.at(i) = 100.0;
    lower.g_nt.at(i) = i <= GaussCoefficients::index(4, 4) ? 100.0 : 0.0;
  }
  const Vector3d position_km{3000.0, -5000.0, 4500.0};
  EXPECT_EQ((MainField{coefficients, 4}.at(position_km).value()),
            (MainField{lower, kHighestDegree}.at(position_km).value()));
}

TEST(MainField, IsThereAtThePolesAndEvenAroundThem) {
  const MainField field = field_of(2024.5);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d pole_km{0.0, 0.0, side * 6800.0};
    const Vector3d at_pole_nt = field.at(pole_km).value();
    EXPECT_TRUE(at_pole_nt.allFinite());
    EXPECT_GT(at_pole_nt.norm(), 40'000.0);
    for (const double way_rad : {0.0, 1.0, 2.5, -2.0}) {
      const Vector3d beside_km =
          pole_km + 1e-3 * Vector3d{std::cos(way_rad), std::sin(way_rad), 0.0};
      // The field changes by about 20 nT a kilometre.
      EXPECT_NEAR((field.at(beside_km).value() - at_pole_nt).norm(), 0.0, 0.05);
    }
  }
}

TEST(MainField, TurnsItsNorthWithTheLongitudeAtAPole) {
  const MainField field = field_of(2024.5);
  const Vector3d at_0_nt = geocentric_nt(field, 90.0, 0.0, 6800.0);
  const Vector3d at_90_nt = geocentric_nt(field, 90.0, 90.0, 6800.0);
  // North at longitude 90 is the direction of west at longitude 0.
  EXPECT_NEAR(at_90_nt.x(), -at_0_nt.y(), 1e-7);
  EXPECT_NEAR(at_90_nt.y(), at_0_nt.x(), 1e-7);
  EXPECT_NEAR(at_90_nt.z(), at_0_nt.z(), 1e-7);
}

TEST(MainField, IsTheSameATurnFurtherEast) {
  const MainField field = field_of(1987.3);
  for (const double longitude_deg : {-180.0, -1.0, 0.0, 179.5}) {
    EXPECT_NEAR((geocentric_nt(field, 33.0, longitude_deg, 6800.0) -
                 geocentric_nt(field, 33.0, longitude_deg + 360.0, 6800.0))
                    .norm(),
                0.0, 1e-7);
  }
}

TEST(MainField, OfAGeodeticPlaceIsTurnedByTheDeflectionOfTheVertical) {
  const MainField field = field_of(2015.0);
  const LocalFrame geodetic = local_frame(GeodeticPlace{45.0 * kRadPerDeg, 0.5, 100.0}).value();
  const Vector3d down = geodetic.q_itrf_ned * Vector3d::UnitZ();
  const Vector3d field_nt = field.ned_at(geodetic).value();
  EXPECT_NEAR(field_nt.z(), field.at(geodetic.origin_itrf_km).value().dot(down), 1e-10);
  EXPECT_NEAR(field_nt.norm(), field.at(geodetic.origin_itrf_km).value().norm(), 1e-10);
}

TEST(MainField, IsRefusedWithinTheCoreAndForWhatIsNoPlace) {
  const MainField field = field_of(2020.0);
  for (const Vector3d& position_km : {Vector3d{0.0, 0.0, 0.0}, Vector3d{0.0, 3479.9, 0.0},
                                      Vector3d{kNan, 0.0, 7000.0}, Vector3d{kInfinity, 0.0, 0.0}}) {
    EXPECT_THAT(field.at(position_km),
                IsRefused(ErrorCode::InvalidInput, HasSubstr("known from 3480 km outwards")));
  }
  EXPECT_TRUE(field.at({0.0, 0.0, 3480.0}));
  EXPECT_NEAR(field.at({1e150, 0.0, 0.0}).value().norm(), 0.0, 1e-300);
}

}  // namespace spindrift::main_field_test
