#include "pipelines/three_axis/field_departure.h"

#include <functional>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::field_departure_test {

using Eigen::Vector3d;
using Of = FieldDeparture::Of;

constexpr double kNoise_nt = 100.0;
const Vector3d kOff_nt{3000.0, -2000.0, 1000.0};

/// @param off_body_nt Difference in body axes of a body with this attitude, without noise.
Of whose(double rate_deg_s, double noise_nt,
         const std::function<Vector3d(const Eigen::Quaterniond&)>& off_body_nt, int seconds = 30) {
  std::mt19937_64 rng{7};
  std::normal_distribution<double> normal{0.0, noise_nt};
  FieldDeparture departure;
  for (int t_s = 0; t_s < seconds; ++t_s) {
    const Eigen::Quaterniond q_icrf_body{
        Eigen::AngleAxisd{rate_deg_s * kRadPerDeg * t_s, Vector3d{0.6, 0.0, 0.8}}};
    const Vector3d noise{normal(rng), normal(rng), normal(rng)};
    departure.add(shifted(TaiTime{}, t_s), q_icrf_body, off_body_nt(q_icrf_body) + noise,
                  kNoise_nt);
  }
  return departure.whose();
}

Vector3d of_magnetometer(const Eigen::Quaterniond& /*q_icrf_body*/) { return kOff_nt; }
Vector3d of_orbit(const Eigen::Quaterniond& q_icrf_body) {
  return q_icrf_body.conjugate() * kOff_nt;
}

TEST(FieldDeparture, IsOfTheFrameInWhichItStandsStill) {
  EXPECT_EQ(whose(1.5, kNoise_nt, &of_magnetometer), Of::Magnetometer);
  EXPECT_EQ(whose(1.5, kNoise_nt, &of_orbit), Of::Orbit);
}

TEST(FieldDeparture, IsOfTheMagnetometerIfItScatters) {
  EXPECT_EQ(whose(0.0, 20.0 * kNoise_nt, &of_orbit), Of::Magnetometer);
}

TEST(FieldDeparture, IsUnknownWhereTheBodyDoesNotTurnOrLittleIsKnown) {
  EXPECT_EQ(whose(0.0, kNoise_nt, &of_orbit), Of::Unknown);
  EXPECT_EQ(whose(1.5, kNoise_nt, &of_orbit, 5), Of::Unknown);
  EXPECT_EQ(whose(1.5, kNoise_nt, [](const auto&) -> Vector3d { return Vector3d::Zero(); }),
            Of::Unknown);
}

}  // namespace spindrift::field_departure_test
