/// Passes with a silent star tracker in the real geomagnetic field: what the magnetometer adds, and
/// whether sigma is consistent with it.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "services/mission/igrf.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::magnetometer_pass_test {

using Eigen::Vector3d;

constexpr int kPasses = 200;
constexpr int kSeconds = 300;
constexpr double kGyro_hz = 4.0;

/// Names the samples that come once a second, with or without a first star fix.
struct Equipment {
  std::string name;
  bool first_star_fix;
  bool field;
};

struct Tally {
  double squared_errors_rad2 = 0.0;
  double nees_midway = 0.0;
  double nees = 0.0;
  Innovations innovations;
};

/// Expects a sum of chi-squares in its central 95 %.
void expect_in_band(double sum, double freedom, const std::string& what) {
  ::testing::Test::RecordProperty(what, std::to_string(sum) + " of " + std::to_string(freedom));
  EXPECT_NEAR(sum, freedom, 1.96 * std::sqrt(2.0 * freedom)) << what;
}

/// Returns a low orbit that stays at least five minutes away from eclipse.
Orbit lit_orbit(std::mt19937_64& rng, const Vector3d& sun_icrf) {
  Vector3d up = normal_vector(rng, 1.0).normalized();
  while (up.dot(sun_icrf) < 0.3) {
    up = normal_vector(rng, 1.0).normalized();
  }
  const Vector3d along = normal_vector(rng, 1.0).cross(up).normalized();
  return Orbit{KeplerOrbit::through(
                   at_s(0.0), {.position_icrf_km = 7028.0 * up, .velocity_icrf_km_s = 7.53 * along})
                   .value()};
}

class MagnetometerPass : public ::testing::Test {
 protected:
  MagnetometerPass() { config_.magnetometer = Magnetometer{.noise_nt = 100.0}; }

  Tally passes(const Equipment& equipment, std::mt19937_64& rng) {
    Tally tally;
    for (int pass = 0; pass < kPasses; ++pass) {
      fly(equipment, rng, tally);
    }
    return tally;
  }

  void fly(const Equipment& equipment, std::mt19937_64& rng, Tally& tally) {
    const TurningBody body = TurningBody::smooth(rng, kSeconds + 1.0, 0.6 * kRadPerDeg);
    const Orbit orbit = lit_orbit(rng, -earth_motion(at_s(0.0)).heliocentric_icrf_km.normalized());
    Sensors sensors{body, config_, rng};
    ThreeAxisPass pass{config_, orbit, model_};
    std::vector<ThreeAxisProduct> products;
    const auto push = [&](const auto& sample) {
      for (ThreeAxisProduct& product : pass.push(sample).products) {
        products.push_back(std::move(product));
      }
    };
    if (equipment.first_star_fix) {
      push(sensors.star(0.0));
    }
    for (int i = 0; i <= kSeconds * kGyro_hz; ++i) {
      const double t_s = i / kGyro_hz;
      push(sensors.gyro(t_s));
      if (i % static_cast<int>(kGyro_hz) != 0) {
        continue;
      }
      const OrbitState at = orbit.at(at_s(t_s)).value();
      push(SunDirection{.t = at_s(t_s),
                        .sun_body = sensors.direction(t_s, sun_.direction_icrf(at_s(t_s), at),
                                                      config_.sun_sensor->noise_rad)});
      if (equipment.field) {
        push(sensors.field(t_s,
                           field_icrf_nt(model_, at_s(t_s), at.position_icrf_km, earth_).value()));
      }
    }
    for (ThreeAxisProduct& product : pass.finish().products) {
      products.push_back(std::move(product));
    }
    count(products, body, tally);
  }

  static void count(const std::vector<ThreeAxisProduct>& products, const TurningBody& body,
                    Tally& tally) {
    for (const ThreeAxisProduct& product : products) {
      ASSERT_FALSE(std::holds_alternative<RejectedSample>(product)) << "a sample is left out";
      const auto* const estimate = std::get_if<AttitudeEstimate>(&product);
      if (estimate == nullptr) {
        continue;
      }
      tally.innovations.squared += estimate->innovations.squared;
      tally.innovations.freedom += estimate->innovations.freedom;
      const double t_s = seconds_between(at_s(0.0), estimate->t);
      if (t_s != kSeconds / 2.0 && t_s != kSeconds) {
        continue;
      }
      const Vector3d off_rad = error_rad(estimate->q_icrf_body, body.q_icrf_body(t_s));
      const double nees = off_rad.dot(estimate->covariance_rad2.ldlt().solve(off_rad));
      (t_s == kSeconds ? tally.nees : tally.nees_midway) += nees;
      tally.squared_errors_rad2 += t_s == kSeconds ? off_rad.squaredNorm() : 0.0;
    }
  }

  ThreeAxisConfig config_ = usual_three_axis();
  MainFieldModel model_ = igrf().value();
  TurningEarth earth_;
  ApparentSun sun_;
};

TEST_F(MagnetometerPass, HasTheSigmaThatItClaimsAndIsWorthALot) {
  std::mt19937_64 rng{1205};
  std::vector<double> rms_deg;
  for (const Equipment& equipment :
       {Equipment{"sun and field", false, true}, Equipment{"star fix, sun and field", true, true},
        Equipment{"star fix and sun", true, false}}) {
    const Tally tally = passes(equipment, rng);
    expect_in_band(tally.nees_midway, 3.0 * kPasses, equipment.name + ", NEES midway");
    expect_in_band(tally.nees, 3.0 * kPasses, equipment.name + ", NEES at the end");
    expect_in_band(tally.innovations.squared, static_cast<double>(tally.innovations.freedom),
                   equipment.name + ", NIS");
    rms_deg.push_back(degrees(std::sqrt(tally.squared_errors_rad2 / kPasses)));
    RecordProperty(equipment.name + ", rms deg", std::to_string(rms_deg.back()));
  }
  // The field observes the rotation about the Sun, in which the gyro bias grows for minutes.
  EXPECT_LT(rms_deg[0], 0.12);
  EXPECT_LT(rms_deg[1], 0.05 * rms_deg[2]);
}

}  // namespace spindrift::testing::magnetometer_pass_test
