#include "tests/support/turning_body.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/sensors/three_axis_reading.h"

namespace spindrift::testing {
namespace {

constexpr double kStep_s = 5e-3;

std::size_t step_at(double t_s) { return static_cast<std::size_t>(std::llround(t_s / kStep_s)); }

}  // namespace

Eigen::Vector3d normal_vector(std::mt19937_64& rng, double sigma) {
  std::normal_distribution<double> normal{0.0, sigma};
  const double x = normal(rng);
  const double y = normal(rng);
  return {x, y, normal(rng)};
}

Eigen::Quaterniond any_attitude(std::mt19937_64& rng) {
  const Eigen::Vector3d vector = normal_vector(rng, 1.0);
  return Eigen::Quaterniond{std::normal_distribution<double>{}(rng), vector.x(), vector.y(),
                            vector.z()}
      .normalized();
}

ThreeAxisConfig usual_three_axis() {
  return {.gyro = GyroSensor{.noise_rad_s = 0.002 * kRadPerDeg,
                             .bias_sigma_rad_s = 0.01 * kRadPerDeg,
                             .range_rad_s = 10.0 * kRadPerDeg},
          .sun_sensor = DigitalSunSensor{.noise_rad = 0.5 * kRadPerDeg},
          .star_tracker =
              StarTracker{.q_body_sensor = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7}.normalized(),
                          .noise_rad = 20.0 / 3600.0 * kRadPerDeg},
          .magnetometer = std::nullopt,
          .inertia = std::nullopt};
}

TurningBody::TurningBody(const Eigen::Quaterniond& q_icrf_body, double duration_s, Rate rate)
    : rate_{std::move(rate)}, q_icrf_body_{q_icrf_body} {
  for (std::size_t step = 0; step < step_at(duration_s); ++step) {
    const Eigen::Vector3d rate_rad_s = rate_((static_cast<double>(step) + 0.5) * kStep_s);
    const double turned_rad = rate_rad_s.norm() * kStep_s;
    const Eigen::Quaterniond turn{Eigen::AngleAxisd{turned_rad, rate_rad_s.stableNormalized()}};
    q_icrf_body_.push_back((q_icrf_body_.back() * turn).normalized());
  }
}

TurningBody TurningBody::smooth(std::mt19937_64& rng, double duration_s, double most_rad_s) {
  std::uniform_real_distribution<double> share{-1.0, 1.0};
  std::array<Eigen::Vector3d, 3> sizes;
  std::array<Eigen::Vector3d, 3> phases;
  std::array<double, 3> frequencies = {};
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      sizes.at(i)[axis] = most_rad_s / 3.0 * share(rng);
      phases.at(i)[axis] = std::numbers::pi * share(rng);
    }
    frequencies.at(i) = 0.4 + 0.35 * share(rng);
  }
  return {any_attitude(rng), duration_s, [=](double t_s) {
            Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
            for (std::size_t i = 0; i < sizes.size(); ++i) {
              rate_rad_s += sizes.at(i).cwiseProduct(
                  (phases.at(i).array() + frequencies.at(i) * t_s).sin().matrix());
            }
            return rate_rad_s;
          }};
}

const Eigen::Quaterniond& TurningBody::q_icrf_body(double t_s) const {
  return q_icrf_body_.at(step_at(t_s));
}

TaiTime at_s(double t_s) { return shifted(tai_from_ns(kStart_tai_ns), t_s); }

Sensors::Sensors(const TurningBody& body, const ThreeAxisConfig& config, std::mt19937_64& rng)
    : body_{body},
      config_{config},
      rng_{rng},
      bias_rad_s_{normal_vector(rng, config.gyro->bias_sigma_rad_s)} {}

GyroSample Sensors::gyro(double t_s) {
  return {.t = at_s(t_s),
          .rate_body_rad_s = gyro_reading(
              body_.rate_rad_s(t_s), bias_rad_s_ + normal_vector(rng_, config_.gyro->noise_rad_s),
              std::nullopt)};
}

StarFix Sensors::star(double t_s) {
  return {.t = at_s(t_s),
          .q_icrf_sensor = star_reading(body_.q_icrf_body(t_s), config_.star_tracker->q_body_sensor,
                                        normal_vector(rng_, config_.star_tracker->noise_rad))};
}

Eigen::Vector3d Sensors::direction(double t_s, const Eigen::Vector3d& ref_icrf, double sigma_rad) {
  return direction_reading(body_.q_icrf_body(t_s).conjugate() * ref_icrf,
                           normal_vector(rng_, sigma_rad).head<2>());
}

MagneticField Sensors::field(double t_s, const Eigen::Vector3d& field_icrf_nt) {
  return {.t = at_s(t_s),
          .field_body_nt = body_.q_icrf_body(t_s).conjugate() * field_icrf_nt +
                           normal_vector(rng_, config_.magnetometer->noise_nt)};
}

Eigen::Vector3d error_rad(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth) {
  const Eigen::AngleAxisd apart{estimate.conjugate() * truth};
  return apart.angle() * apart.axis();
}

}  // namespace spindrift::testing
