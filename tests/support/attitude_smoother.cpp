#include "tests/support/attitude_smoother.h"

#include <Eigen/Dense>
#include <algorithm>

namespace spindrift::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

Matrix3d cross_of(const Vector3d& v) {
  Matrix3d cross;
  cross.col(0) = v.cross(Vector3d::UnitX());
  cross.col(1) = v.cross(Vector3d::UnitY());
  cross.col(2) = v.cross(Vector3d::UnitZ());
  return cross;
}

Quaterniond turned(const Quaterniond& q, const Vector3d& vector_rad) {
  return (q * Quaterniond{Eigen::AngleAxisd{vector_rad.norm(), vector_rad.stableNormalized()}})
      .normalized();
}

Vector3d vector_of(const Quaterniond& q) {
  const Eigen::AngleAxisd turn{q.w() < 0.0 ? Quaterniond{-q.coeffs()} : q};
  return turn.angle() * turn.axis();
}

/// Returns the rotation vector in body axes and the bias change from one estimate to another.
Vector6d difference(const SmoothedAttitude& from, const SmoothedAttitude& to) {
  Vector6d off;
  off << vector_of(from.q_icrf_body.conjugate() * to.q_icrf_body), to.bias_rad_s - from.bias_rad_s;
  return off;
}

void move(SmoothedAttitude& at, const Vector6d& by) {
  at.q_icrf_body = turned(at.q_icrf_body, by.head<3>());
  at.bias_rad_s += by.tail<3>();
}

/// Applies a Kalman update with a measurement of three components.
/// @param off Measured minus predicted value.
/// @param noise Standard deviation of each component.
void update(SmoothedAttitude& at, const Vector3d& off, const Matrix3d& slopes, double noise) {
  Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
  H.leftCols<3>() = slopes;
  const Matrix3d innovation =
      H * at.covariance * H.transpose() + noise * noise * Matrix3d::Identity();
  const Eigen::Matrix<double, 6, 3> gain = at.covariance * H.transpose() * innovation.inverse();
  move(at, gain * off);
  const Matrix6d kept = Matrix6d::Identity() - gain * H;
  at.covariance = kept * at.covariance * kept.transpose() + noise * noise * gain * gain.transpose();
}

struct Step {
  SmoothedAttitude predicted;
  Matrix6d transition;
};

}  // namespace

std::vector<SmoothedAttitude> smoothed(const Observations& all, const SmootherNoise& noise) {
  std::vector<double> times_s{0.0, all.end_s};
  for (const SunObservation& sun : all.sun) {
    times_s.push_back(sun.t_s);
  }
  for (const StarObservation& star : all.stars) {
    times_s.push_back(star.t_s);
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  SmoothedAttitude at{0.0, all.stars.front().q_icrf_body, Vector3d::Zero(), Matrix6d::Zero()};
  at.covariance.diagonal() << Vector3d::Constant(noise.star_rad * noise.star_rad),
      Vector3d::Constant(noise.bias_rad_s * noise.bias_rad_s);
  std::vector<SmoothedAttitude> filtered;
  std::vector<Step> steps;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (i > 0) {
      const std::vector<double> ends{times_s[i - 1], times_s[i]};
      const Turn turn = all.rates.turns(ends, at.bias_rad_s).front();
      Matrix6d transition = Matrix6d::Identity();
      transition.topLeftCorner<3, 3>() = turn.turn.toRotationMatrix().transpose();
      transition.topRightCorner<3, 3>() = turn.per_bias_s;
      at.t_s = times_s[i];
      at.q_icrf_body = (at.q_icrf_body * turn.turn).normalized();
      at.covariance = transition * at.covariance * transition.transpose();
      at.covariance.topLeftCorner<3, 3>() += turn.covariance_rad2;
      steps.push_back({at, transition});
    }
    for (const SunObservation& sun : all.sun) {
      if (sun.t_s == at.t_s) {
        const Vector3d predicted = at.q_icrf_body.conjugate() * sun.sun_icrf;
        update(at, sun.measured_body - predicted, cross_of(predicted), noise.sun_rad);
      }
    }
    for (const StarObservation& star : all.stars) {
      if (star.t_s == at.t_s && at.t_s > 0.0) {
        update(at, vector_of(at.q_icrf_body.conjugate() * star.q_icrf_body), Matrix3d::Identity(),
               noise.star_rad);
      }
    }
    filtered.push_back(at);
  }
  std::vector<SmoothedAttitude> back = filtered;
  for (std::size_t i = filtered.size() - 1; i-- > 0;) {
    const Step& step = steps[i];
    const Matrix6d gain =
        filtered[i].covariance * step.transition.transpose() * step.predicted.covariance.inverse();
    move(back[i], gain * difference(step.predicted, back[i + 1]));
    back[i].covariance +=
        gain * (back[i + 1].covariance - step.predicted.covariance) * gain.transpose();
  }
  return back;
}

}  // namespace spindrift::testing
