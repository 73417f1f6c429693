/// The main field at random places and dates agrees with another library and with Maxwell's
/// equations.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "services/mission/igrf.h"
#include "tests/support/geographiclib_field.h"

namespace spindrift::testing::main_field_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns a position between the core boundary and ten Earth radii, more often near.
Vector3d any_position_km(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> ratio{0.1, 1.8};
  return kFieldRadius_km / ratio(rng) *
         Vector3d{normal(rng), normal(rng), normal(rng)}.normalized();
}

TEST(MainFieldProperty, IsGeographicLibs) {
  std::mt19937_64 rng{1701};
  std::uniform_real_distribution<double> year{1900.0, 2030.0};
  std::uniform_int_distribution<int> degree{1, kHighestDegree};
  const MainFieldModel model = igrf().value();
  for (int i = 0; i < 2000; ++i) {
    const Vector3d position_km = any_position_km(rng);
    const double at_year = year(rng);
    const int to_degree = degree(rng);
    const Vector3d expected_nt =
        GeographicLibField{model.coefficients(at_year).value(), to_degree}.at(position_km);
    const Vector3d field_nt = model.at(at_year, to_degree)->at(position_km).value();
    ASSERT_NEAR((field_nt - expected_nt).norm() / expected_nt.norm(), 0.0, 1e-12)
        << at_year << " degree " << to_degree << " at " << position_km.transpose();
  }
}

/// Returns the gradient dB_i/dx_j by fourth-order differences.
Matrix3d slope_nt_km(const MainField& field, const Vector3d& position_km) {
  constexpr double kStep_km = 10.0;
  Matrix3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step_km = kStep_km * Vector3d::Unit(axis);
    const auto across = [&](double steps) -> Vector3d {
      return field.at(position_km + steps * step_km).value() -
             field.at(position_km - steps * step_km).value();
    };
    slope.col(axis) = (8.0 * across(1.0) - across(2.0)) / (12.0 * kStep_km);
  }
  return slope;
}

TEST(MainFieldProperty, HasNeitherSourcesNorCurrentsOutside) {
  std::mt19937_64 rng{1702};
  std::uniform_real_distribution<double> year{1900.0, 2030.0};
  const MainFieldModel model = igrf().value();
  for (int i = 0; i < 300; ++i) {
    const MainField field = model.at(year(rng)).value();
    Vector3d position_km = any_position_km(rng);
    position_km *= std::max(1.0, 6300.0 / position_km.norm());
    const Matrix3d slope = slope_nt_km(field, position_km);
    // The truncation error (fifth derivative) is 1e-8 of the gradient here.
    EXPECT_NEAR(slope.trace() / slope.norm(), 0.0, 1e-6);
    EXPECT_NEAR((slope - slope.transpose()).norm() / slope.norm(), 0.0, 1e-6);
  }
}

TEST(MainFieldProperty, TurnsWithTheEarth) {
  // Rotating the coefficients about the Earth's axis must rotate the field by the same angle.
  std::mt19937_64 rng{1703};
  std::uniform_real_distribution<double> angle{-3.0, 3.0};
  const GaussCoefficients coefficients = igrf().value().coefficients(2021.7).value();
  for (int i = 0; i < 50; ++i) {
    const double turned_rad = angle(rng);
    GaussCoefficients turned = coefficients;
    for (int n = 1; n <= kHighestDegree; ++n) {
      for (int m = 0; m <= n; ++m) {
        const std::size_t at = GaussCoefficients::index(n, m);
        const double cosine = std::cos(m * turned_rad);
        const double sine = std::sin(m * turned_rad);
        turned.g_nt.at(at) = cosine * coefficients.g_nt.at(at) - sine * coefficients.h_nt.at(at);
        turned.h_nt.at(at) = sine * coefficients.g_nt.at(at) + cosine * coefficients.h_nt.at(at);
      }
    }
    const Eigen::AngleAxisd turn{turned_rad, Vector3d::UnitZ()};
    const Vector3d position_km = any_position_km(rng);
    const Vector3d expected_nt =
        turn * MainField{coefficients, kHighestDegree}.at(position_km).value();
    const Vector3d field_nt = MainField{turned, kHighestDegree}.at(turn * position_km).value();
    EXPECT_NEAR((field_nt - expected_nt).norm() / expected_nt.norm(), 0.0, 1e-12);
  }
}

}  // namespace spindrift::testing::main_field_test
