#include "tests/support/misaligned_pass.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/of_kind.h"

namespace spindrift::testing {
namespace {

using Eigen::Vector3d;

constexpr int kGyro_hz = 10;
constexpr double kField_nt = 40'000.0;

}  // namespace

AlignmentErrors default_alignment() {
  AlignmentErrors sigmas;
  sigmas.segment<3>(StarTrackerError).setConstant(0.01 * kRadPerDeg);
  sigmas.segment<3>(SunSensorError).setConstant(0.2 * kRadPerDeg);
  sigmas.segment<3>(MagnetometerError).setConstant(0.3 * kRadPerDeg);
  sigmas.segment<3>(MagnetometerBiasError).setConstant(100.0);
  sigmas.segment<3>(GyroScaleError).setConstant(0.001);
  sigmas.segment<6>(GyroAxisError).setConstant(0.05 * kRadPerDeg);
  sigmas.segment<3>(StarTrackerTimeError).setConstant(0.01);
  sigmas.segment<3>(InertiaError).setConstant(0.05);
  return sigmas;
}

AlignmentErrors drawn(const AlignmentErrors& sigmas, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  AlignmentErrors errors;
  for (double& error : errors) {
    error = normal(rng);
  }
  return errors.cwiseProduct(sigmas);
}

MisalignedSensors::MisalignedSensors(const TurningBody& body, const ThreeAxisConfig& config,
                                     const AlignmentErrors& errors, std::mt19937_64& rng)
    : body_{body}, config_{config}, errors_{errors}, sensors_{body, config, rng} {}

GyroSample MisalignedSensors::gyro(double t_s) {
  const Vector3d across = errors_.segment<6>(GyroAxisError)(Eigen::seq(0, 4, 2));
  const Vector3d other = errors_.segment<6>(GyroAxisError)(Eigen::seq(1, 5, 2));
  const Vector3d rate_rad_s = body_.rate_rad_s(t_s);
  const auto [x, y, z] = std::array{rate_rad_s.x(), rate_rad_s.y(), rate_rad_s.z()};
  GyroSample sample = sensors_.gyro(t_s);
  sample.rate_body_rad_s += errors_.segment<3>(GyroScaleError).cwiseProduct(rate_rad_s) +
                            across.cwiseProduct(Vector3d{y, x, x}) +
                            other.cwiseProduct(Vector3d{z, z, y});
  return sample;
}

/// Returns the rotation of true directions, body axes, into those that a sensor reports which is
/// mounted wrongly and whose stamp is late.
Eigen::Quaterniond MisalignedSensors::turned_by(double t_s, int mounting, int time_tag) const {
  return quaternion_by(errors_.segment<3>(mounting)) *
         quaternion_by(errors_[time_tag] * body_.rate_rad_s(t_s - 0.5 * errors_[time_tag]));
}

StarFix MisalignedSensors::star(double t_s) {
  StarFix fix = sensors_.star(t_s);
  const Eigen::Quaterniond& q_icrf_body = body_.q_icrf_body(t_s);
  fix.q_icrf_sensor = q_icrf_body *
                      turned_by(t_s, StarTrackerError, StarTrackerTimeError).conjugate() *
                      q_icrf_body.conjugate() * fix.q_icrf_sensor;
  return fix;
}

Vector3d MisalignedSensors::sun(double t_s, const Vector3d& ref_icrf) {
  return turned_by(t_s, SunSensorError, SunSensorTimeError) *
         sensors_.direction(t_s, ref_icrf, config_.sun_sensor->noise_rad);
}

Vector3d MisalignedSensors::field_nt(double t_s, const Vector3d& ref_icrf_nt) {
  return turned_by(t_s, MagnetometerError, MagnetometerTimeError) *
             sensors_.field(t_s, ref_icrf_nt).field_body_nt +
         errors_.segment<3>(MagnetometerBiasError);
}

double JudgedAttitude::square() const {
  return error_rad.dot(estimate.covariance_rad2.ldlt().solve(error_rad));
}

MisalignedPass fly(const MisalignedScene& scene, const AlignmentErrors& errors,
                   const AlignmentErrors& alignment, std::mt19937_64& rng) {
  ThreeAxisConfig config = usual_three_axis();
  config.magnetometer = Magnetometer{.noise_nt = 100.0};
  config.alignment = alignment.cwiseAbs2().asDiagonal();
  const TurningBody body = TurningBody::smooth(rng, scene.duration_s + 1.0, scene.most_rad_s);
  MisalignedSensors sensors{body, config, errors, rng};
  const Vector3d sun = normal_vector(rng, 1.0).normalized();
  const Vector3d field_axis = normal_vector(rng, 1.0).normalized();
  Vector3d field_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  while (std::abs(field_nt.dot(sun)) > 0.9 * kField_nt) {
    field_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  }
  MisalignedPass pass{.rows = {}, .estimator = AttitudeEstimator{config}};
  AttitudeEstimator::Products products;
  for (int i = 0; i <= scene.duration_s * kGyro_hz; ++i) {
    const double t_s = static_cast<double>(i) / kGyro_hz;
    pass.estimator.push(sensors.gyro(t_s), products);
    if (i % kGyro_hz != 0) {
      continue;
    }
    if (scene.star) {
      pass.estimator.push(sensors.star(t_s), products);
    }
    if (scene.sun) {
      pass.estimator.push(SeenDirection{at_s(t_s),
                                        SampleKind::Sun,
                                        {sensors.sun(t_s, sun), sun, config.sun_sensor->noise_rad}},
                          products);
    }
    if (scene.field) {
      // In low orbit the direction of the field goes round twice in 90 minutes.
      const Vector3d ref_nt = quaternion_by(2.3e-3 * t_s * field_axis) * field_nt;
      const Vector3d measured_nt = sensors.field_nt(t_s, ref_nt);
      const double noise_nt = config.magnetometer->noise_nt;
      pass.estimator.push(SeenDirection{.t = at_s(t_s),
                                        .kind = SampleKind::Magnetometer,
                                        .direction = {measured_nt, ref_nt, noise_nt / kField_nt},
                                        .stronger = (measured_nt.norm() - kField_nt) / noise_nt},
                          products);
    }
  }
  pass.estimator.settle(products);
  for (const AttitudeEstimate& estimate : of_kind<AttitudeEstimate>(products)) {
    const double t_s = seconds_between(at_s(0.0), estimate.t);
    pass.rows.push_back({.t_s = t_s,
                         .estimate = estimate,
                         .error_rad = error_rad(estimate.q_icrf_body, body.q_icrf_body(t_s))});
  }
  return pass;
}

namespace {

struct Equipment {
  const char* name;
  MisalignedScene scene;
};

struct Tally {
  double squares = 0.0;  ///< Sum over the last OK row of each pass.
  double freedom = 0.0;
  double squares_of_errors = 0.0;  ///< Sum over the estimates of the errors.
  int ok = 0;
  int beyond_four = 0;
  double worst = 0.0;

  void add(const MisalignedPass& pass) {
    const JudgedAttitude* last = nullptr;
    for (const JudgedAttitude& row : pass.rows) {
      if (row.is_ok()) {
        last = &row;
        ++ok;
        beyond_four += row.sigmas() > 4.0 ? 1 : 0;
        worst = std::max(worst, row.sigmas());
      }
    }
    if (last != nullptr) {
      squares += last->square();
      freedom += 3.0;
    }
  }
};

/// Returns the chi-square of what the innovations of a pass say of the errors with their prior.
double square_of_estimate(const AlignmentEvidence& evidence, const AlignmentErrors& errors) {
  const FilterAlignment information =
      FilterAlignment{evidence.prior().diagonal().cwiseInverse().asDiagonal()} +
      evidence.information();
  const AlignmentEvidence::Vector off =
      information.ldlt().solve(evidence.score()) - errors.head<kFilterErrors>();
  return off.dot(information * off);
}

/// Expects a sum of chi-squares in its central 95 %.
void expect_in_band(double sum, double freedom, const std::string& what) {
  ::testing::Test::RecordProperty(what, fmt::format("{:.1f} of {:.0f}", sum, freedom));
  EXPECT_NEAR(sum, freedom, 1.96 * std::sqrt(2.0 * freedom)) << what;
}

}  // namespace

void expect_sigma_that_holds(int passes_of_each) {
  const AlignmentErrors stated = default_alignment();
  const AlignmentErrors exact = AlignmentErrors::Zero();
  std::mt19937_64 rng{4600};
  for (const auto& [name, scene] :
       {Equipment{"star", {true, false, false, 0.6 * kRadPerDeg, 200}},
        Equipment{"star and Sun", {true, true, false, 0.6 * kRadPerDeg, 200}},
        Equipment{"Sun and field", {false, true, true, 0.6 * kRadPerDeg, 200}}}) {
    Tally of_drawn;
    Tally of_exact;
    for (int i = 0; i < passes_of_each; ++i) {
      const AlignmentErrors errors = drawn(stated, rng);
      std::mt19937_64 again = rng;
      const MisalignedPass pass = fly(scene, errors, stated, rng);
      of_drawn.add(pass);
      of_drawn.squares_of_errors += square_of_estimate(pass.estimator.filter()->evidence(), errors);
      of_exact.add(fly(scene, exact, exact, again));
    }
    const std::string what = name;
    expect_in_band(of_drawn.squares, of_drawn.freedom, what + ", attitude");
    expect_in_band(of_drawn.squares_of_errors, kFilterErrors * passes_of_each, what + ", errors");
    EXPECT_LE(of_drawn.beyond_four, 0.001 * of_drawn.ok) << what;
    EXPECT_LT(of_drawn.worst, 5.0) << what;
    EXPECT_GE(of_drawn.ok, 0.98 * of_exact.ok) << what;
    ::testing::Test::RecordProperty(what + ", OK rows",
                                    fmt::format("{} of {} by an exact file, at worst {:.2f} sigma",
                                                of_drawn.ok, of_exact.ok, of_drawn.worst));
  }
}

}  // namespace spindrift::testing
