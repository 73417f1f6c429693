#include "tests/support/separation_flight.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"

namespace spindrift::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep_s = 0.05;
constexpr std::int64_t kStep_ns = 50'000'000;
const TaiTime kSeparation = tai_from_ns(1'772'337'637'000'000'000);
const Vector3d kMoments_kg_m2{120.0, 100.0, 140.0};

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_{seed} {}
  Vector3d vector(double sigma) {
    return {sigma * normal_(generator_), sigma * normal_(generator_), sigma * normal_(generator_)};
  }

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

/// Columns orthonormal again.
Matrix3d squared_up(const Matrix3d& matrix) {
  const Vector3d x = matrix.col(0).normalized();
  const Vector3d z = x.cross(matrix.col(1)).normalized();
  Matrix3d result;
  result << x, z.cross(x), z;
  return result;
}

Matrix3d turned_by(const Matrix3d& R, const Vector3d& vector_rad) {
  return R * Eigen::AngleAxisd{vector_rad.norm(), vector_rad.stableNormalized()}.matrix();
}

class Body {
 public:
  Body(const Matrix3d& R, const Vector3d& rate_rad_s)
      : R_{R}, momentum_icrf_{R * kMoments_kg_m2.cwiseProduct(rate_rad_s)} {}

  Vector3d rate() const { return (R_.transpose() * momentum_icrf_).cwiseQuotient(kMoments_kg_m2); }
  const Matrix3d& R() const { return R_; }

  /// The momentum in ICRF changes by the torque alone; the matrix follows, at the rate half a step
  /// on.
  void step(const Vector3d& torque_body_nm) {
    momentum_icrf_ += 0.5 * kStep_s * (R_ * torque_body_nm);
    const Matrix3d before = R_;
    for (int i = 0; i < 3; ++i) {
      const Matrix3d middle = squared_up(0.5 * (before + R_));
      const Vector3d rate = (middle.transpose() * momentum_icrf_).cwiseQuotient(kMoments_kg_m2);
      R_ = turned_by(before, kStep_s * rate);
    }
    momentum_icrf_ += 0.5 * kStep_s * (R_ * torque_body_nm);
  }

 private:
  Matrix3d R_;
  Vector3d momentum_icrf_;
};

/// Thrusters that are on or off, with a dead zone.
Vector3d relay_torque(const Vector3d& rate_rad_s) {
  constexpr double kDead_rad_s = 0.03 * kRadPerDeg;
  constexpr double kTorque_nm = 0.08;
  return rate_rad_s.unaryExpr([](double w) {
    return std::abs(w) > kDead_rad_s ? (w > 0.0 ? -kTorque_nm : kTorque_nm) : 0.0;
  });
}

/// Turns -Zb to the Sun, at most half a degree per second.
Vector3d acquisition_torque(const Vector3d& rate_rad_s, const Vector3d& sun_body) {
  constexpr double kMost_rad_s = 0.5 * kRadPerDeg;
  constexpr double kMost_nm = 0.2;
  const Vector3d axis = -Vector3d::UnitZ().cross(sun_body);
  Vector3d wanted = 0.03 * axis;
  if (sun_body.z() > 0.0) {
    wanted = 0.03 * (axis + 1e-3 * Vector3d::UnitX()).normalized();
  }
  wanted *= std::min(1.0, kMost_rad_s / std::max(wanted.norm(), 1e-12));
  const Vector3d torque = kMoments_kg_m2.cwiseProduct(0.1 * (wanted - rate_rad_s));
  return torque.cwiseMax(-kMost_nm).cwiseMin(kMost_nm);
}

bool is_due(double t_s, double step_s) {
  return step_s > 0.0 && std::abs(t_s / step_s - std::round(t_s / step_s)) < 1e-6;
}

Eigen::Quaterniond as_measured(const Matrix3d& R_icrf_body, const Eigen::Quaterniond& q_body_sensor,
                               const Vector3d& error_rad) {
  return Eigen::Quaterniond{turned_by(R_icrf_body, error_rad)} * q_body_sensor;
}

}  // namespace

Vector3d SeparationFlight::error_rad(std::size_t event, const Eigen::Quaterniond& found) const {
  const Eigen::AngleAxisd off{
      Matrix3d{found.normalized().toRotationMatrix().transpose() * R_icrf_body[event]}};
  return off.angle() * off.axis();
}

SeparationFlight separation_flight(const FlightPlan& plan, std::uint64_t seed) {
  Noise noise{seed};
  const auto at = [](double t_s) { return shifted(kSeparation, t_s); };
  const double deg_s = kRadPerDeg;
  SeparationFlight flight{
      .sensors = {.gyro = GyroSensor{.noise_rad_s = plan.gyro_noise_deg_s * deg_s,
                                     .bias_sigma_rad_s = plan.bias_sigma_deg_s * deg_s,
                                     .range_rad_s = std::nullopt},
                  .sun_sensor = DigitalSunSensor{plan.sun_noise_deg * kRadPerDeg},
                  .star_tracker =
                      StarTracker{Eigen::Quaterniond{0.876, 0.192, -0.096, 0.431}.normalized(),
                                  plan.star_noise_arcsec / 3600.0 * kRadPerDeg},
                  .magnetometer = std::nullopt,
                  .inertia = Inertia{kMoments_kg_m2.asDiagonal(), 0.0}},
      .times = {at(0.0), at(plan.control_on_s), at(plan.acquisition_s), at(plan.first_star_fix_s)},
      .gyro = {},
      .sun = {},
      .stars = {},
      .bias_rad_s = noise.vector(plan.bias_sigma_deg_s * deg_s),
      .R_icrf_body = {}};
  ApparentSun sun;
  Body body{turned_by(Matrix3d::Identity(), noise.vector(2.0)),
            noise.vector(0.35 * deg_s) + Vector3d{0.3, -0.2, 0.05} * deg_s};
  const auto steps = static_cast<std::int64_t>(std::llround(plan.end_s / kStep_s));
  for (std::int64_t i = 0; i <= steps; ++i) {
    const double t_s = static_cast<double>(i) * kStep_s;
    const TaiTime t = kSeparation + std::chrono::nanoseconds{i * kStep_ns};
    const auto reached = [&](double event_s) { return t_s >= event_s - 1e-6; };
    for (const double event_s :
         {0.0, plan.control_on_s, plan.acquisition_s, plan.first_star_fix_s}) {
      if (std::abs(t_s - event_s) < 1e-6) {
        flight.R_icrf_body.push_back(body.R());
      }
    }
    if (reached(plan.control_on_s) && is_due(t_s, plan.gyro_step_s)) {
      flight.gyro.push_back(
          {t, body.rate() + flight.bias_rad_s + noise.vector(plan.gyro_noise_deg_s * deg_s)});
    }
    const Vector3d sun_body =
        body.R().transpose() * sun.direction_icrf(t, {Vector3d::Zero(), Vector3d::Zero()});
    if (reached(plan.acquisition_s) && is_due(t_s, plan.sun_step_s)) {
      flight.sun.push_back(
          {t, (sun_body + noise.vector(plan.sun_noise_deg * kRadPerDeg)).normalized()});
    }
    const double since_fix_s = t_s - plan.first_star_fix_s;
    if (std::abs(since_fix_s) < 1e-6 ||
        (since_fix_s > 0.0 && is_due(since_fix_s, plan.star_fix_step_s))) {
      flight.stars.push_back(
          {t, as_measured(body.R(), flight.sensors.star_tracker->q_body_sensor,
                          noise.vector(flight.sensors.star_tracker->noise_rad))});
    }
    body.step(reached(plan.acquisition_s)  ? acquisition_torque(body.rate(), sun_body)
              : reached(plan.control_on_s) ? relay_torque(body.rate())
                                           : Vector3d::Zero());
  }
  return flight;
}

}  // namespace spindrift::testing
