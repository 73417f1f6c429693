/// @file
/// What both unscented filters share: attitude, further states, errors of the sensors as states
/// with the prior of the mission file, and the update by a measurement.
///
/// The state is the quaternion q_icrf_body and a vector x whose first three components are zero. In
/// its error these are the generalised Rodrigues parameters of the turn in body axes,
///
///     q_true = q * quaternion_of_rodrigues(p),
///
/// which each update moves into the quaternion (Crassidis and Markley 2003). A component whose
/// prior variance is zero is exactly known and stays as it is. As the errors of the mission file
/// are states, the covariance is total, and innovations are independent of each other.

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <type_traits>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/statistics/linear_update.h"
#include "pipelines/three_axis/unscented/measurements.h"
#include "pipelines/three_axis/unscented/rodrigues.h"
#include "pipelines/three_axis/unscented/statistical_linearisation.h"

namespace spindrift {

/// @tparam kMoving Number of components that the attitude at a later time depends on, the three of
///         the attitude included; they come first, then those of SensorErrorState.
/// @tparam kErrors First component that is an error of the mission file, as all behind it.
template <int kMoving, int kErrors>
struct UnscentedAttitude {
  static constexpr int kStates = kMoving + kSensorErrorStates;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;
  using Moving = Eigen::Matrix<double, kMoving, 1>;

  Eigen::Quaterniond q_icrf_body;
  State state = State::Zero();
  Covariance covariance = Covariance::Zero();

  /// Sets the prior of the errors, and that they have nothing to do with the other states.
  /// @param moving Indices in the alignment of the errors in front of those of the sensors.
  void set_errors(const AttitudeAlignment& alignment,
                  const std::array<int, kMoving - kErrors>& moving) {
    const auto index = [&](int of) {
      return of < kMoving ? moving.at(static_cast<std::size_t>(of - kErrors))
                          : kSensorErrors.at(static_cast<std::size_t>(of - kMoving));
    };
    for (int i = kErrors; i < kStates; ++i) {
      for (int j = kErrors; j < kStates; ++j) {
        covariance(i, j) = alignment(index(i), index(j));
      }
    }
  }

  /// Advances attitude and the `kOut` first components.
  /// @param q_after Attitude that the present estimate leads to.
  /// @param f As for linearised(), with the turn relative to `q_after` as the first components.
  template <int kOut, class Function>
  void propagate(const Eigen::Quaterniond& q_after, const Function& f) {
    const auto linear = linearised<kOut, kMoving>(
        Eigen::Matrix<double, kMoving, kMoving>{
            covariance.template topLeftCorner<kMoving, kMoving>()},
        f);
    const Eigen::Matrix<double, kOut, kStates> across =
        linear.slope * covariance.template topRows<kMoving>();
    covariance.template topLeftCorner<kOut, kOut>() =
        across.template leftCols<kMoving>() * linear.slope.transpose() + linear.curved;
    covariance.template topRightCorner<kOut, kStates - kOut>() =
        across.template rightCols<kStates - kOut>();
    covariance.template bottomLeftCorner<kStates - kOut, kOut>() =
        across.template rightCols<kStates - kOut>().transpose();
    state.template head<kOut>() += linear.shift;
    take_turn(q_after);
  }

  /// A measurement of three components, linear in the state.
  struct Seen {
    Eigen::Vector3d off;  ///< Measured minus expected.
    Eigen::Matrix<double, 3, kStates> slope = Eigen::Matrix<double, 3, kStates>::Zero();
    Eigen::Matrix3d noise;  ///< Covariance of what is not linear in the state.
    double sigma;           ///< That of the sensor, each component.

    Eigen::Matrix3d expected(const Covariance& before) const {
      return slope * before * slope.transpose() + noise;
    }
  };

  Seen seen_from(const SeenField& field, const Eigen::Vector3d& rate_rad_s) const {
    Seen seen = of_vector(field.body_nt, field.ref_icrf_nt, field.noise_nt, rate_rad_s,
                          FieldMounting, FieldTime, state.template segment<3>(kMoving + FieldBias));
    seen.slope.template middleCols<3>(kMoving + FieldBias).setIdentity();
    return seen;
  }
  Seen seen_from(const SeenSun& sun, const Eigen::Vector3d& rate_rad_s) const {
    return of_vector(sun.body, sun.ref_icrf, sun.sigma_rad, rate_rad_s, SunMounting, SunTime,
                     Eigen::Vector3d::Zero());
  }
  Seen seen_from(const SeenStars& stars, const Eigen::Vector3d& rate_rad_s) const {
    Seen seen;
    seen.sigma = stars.sigma_rad;
    seen.noise = stars.sigma_rad * stars.sigma_rad * Eigen::Matrix3d::Identity();
    seen.off = rodrigues_of(q_icrf_body.conjugate() * stars.q_icrf_body) +
               state.template segment<3>(kMoving + StarMounting) +
               rate_rad_s * state[kMoving + StarTime];
    seen.slope.template leftCols<3>().setIdentity();
    seen.slope.template middleCols<3>(kMoving + StarMounting) = -Eigen::Matrix3d::Identity();
    seen.slope.col(kMoving + StarTime) = -rate_rad_s;
    return seen;
  }

  template <class Measurement>
  UnscentedInnovation innovation(const Measurement& measurement,
                                 const Eigen::Vector3d& rate_rad_s) const {
    const Seen seen = seen_from(measurement, rate_rad_s);
    const Eigen::Matrix3d expected = seen.expected(covariance);
    const Eigen::LLT<Eigen::Matrix3d> factor{expected};
    UnscentedInnovation innovation{.residual = residual_of(measurement, seen, expected),
                                   .nis = seen.off.dot(factor.solve(seen.off)),
                                   .log_likelihood = 0.0};
    const Eigen::Vector3d diagonal = factor.matrixLLT().diagonal();
    innovation.log_likelihood =
        -0.5 * innovation.nis - std::log(diagonal.prod() / (seen.sigma * seen.sigma * seen.sigma));
    return innovation;
  }

  /// Updates the state. The measurement is linearised over what is possible after it, from the
  /// state before it, so that a large correction does not claim knowledge of a turn that the
  /// measurement does not show (Garcia-Fernandez and others 2015). A vector that points the other
  /// way tells little of how far it is to turn, so that this takes many passes.
  template <class Measurement>
  void update(const Measurement& measurement, const Eigen::Vector3d& rate_rad_s) {
    constexpr int kMostPasses = 20;
    const UnscentedAttitude before = *this;
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
    for (int pass = 0; pass < kMostPasses; ++pass) {
      Seen seen = seen_from(measurement, rate_rad_s);
      seen.off += seen.slope.template leftCols<3>() * turn_rad +
                  seen.slope.template rightCols<kStates - 3>() *
                      (state - before.state).template tail<kStates - 3>();
      seen.slope.template leftCols<3>() *= right_jacobian(turn_rad);
      const Eigen::Matrix<double, 3, kStates> shared = seen.slope * before.covariance;
      const Eigen::Matrix3d expected = shared * seen.slope.transpose() + seen.noise;
      const Eigen::LLT<Eigen::Matrix3d> factor{expected};
      const Eigen::Matrix<double, 3, kStates> whitened = factor.matrixL().solve(shared);
      const State more = whitened.transpose() * factor.matrixL().solve(seen.off);
      const double change_rad = (more.template head<3>() - turn_rad).norm();
      turn_rad = more.template head<3>();
      covariance = before.covariance;
      covariance.noalias() -= whitened.transpose() * whitened;
      refer_to_turned(turn_rad);
      state = before.state + more;
      take_turn(before.q_icrf_body);
      if (!(change_rad > kFarFromLinear_rad)) {
        break;
      }
    }
  }

  /// Returns the covariance of the turn if the errors of the mission file were known.
  Eigen::Matrix3d attitude_noise_rad2() const {
    constexpr int kCount = kStates - kErrors;
    const auto factor =
        lower_factor<kCount>(covariance.template bottomRightCorner<kCount, kCount>());
    Eigen::Matrix<double, kCount, 3> shared = covariance.template bottomLeftCorner<kCount, 3>();
    for (int i = 0; i < kCount; ++i) {
      shared.row(i) -= factor.row(i).head(i) * shared.topRows(i);
      shared.row(i) *= factor(i, i) == 0.0 ? 0.0 : 1.0 / factor(i, i);
    }
    return covariance.template topLeftCorner<3, 3>() - shared.transpose() * shared;
  }

 private:
  /// Refers the covariance to body axes that are turned.
  void refer_to_turned(const Eigen::Vector3d& turn_rad) {
    const Eigen::Matrix3d moved = right_jacobian(turn_rad);
    covariance.template topRows<3>() = (moved * covariance.template topRows<3>()).eval();
    covariance.template leftCols<3>() =
        (covariance.template leftCols<3>() * moved.transpose()).eval();
  }

  /// Moves the turn of the state into the quaternion.
  /// @param from Attitude that the turn is relative to.
  void take_turn(const Eigen::Quaterniond& from) {
    q_icrf_body = (from * quaternion_by(state.template head<3>())).normalized();
    state.template head<3>().setZero();
  }

  /// The sensor measures the vector as it was before a time tag that is too late, in its own axes.
  Seen of_vector(const Eigen::Vector3d& body, const Eigen::Vector3d& ref_icrf, double sigma,
                 const Eigen::Vector3d& rate_rad_s, int mounting, int time,
                 const Eigen::Vector3d& bias) const {
    const Eigen::Matrix3d mounted =
        rotation_by(state.template segment<3>(kMoving + mounting)) *
        (Eigen::Matrix3d::Identity() + state[kMoving + time] * cross_matrix(rate_rad_s));
    const Eigen::Vector3d here = q_icrf_body.conjugate() * ref_icrf;
    const auto turned = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
      return mounted * (quaternion_of_rodrigues(p).conjugate() * here - here);
    };
    const auto linear =
        linearised<3, 3>(Eigen::Matrix3d{covariance.template topLeftCorner<3, 3>()}, turned);
    const Eigen::Vector3d expected = mounted * here + linear.shift;
    Seen seen;
    seen.sigma = sigma;
    seen.off = body - expected - bias;
    seen.noise = linear.curved + sigma * sigma * Eigen::Matrix3d::Identity();
    seen.slope.template leftCols<3>() = linear.slope;
    seen.slope.template middleCols<3>(kMoving + mounting) = -cross_matrix(expected);
    seen.slope.col(kMoving + time) = rate_rad_s.cross(expected);
    return seen;
  }

  template <class Measurement>
  static Residual residual_of(const Measurement& measurement, const Seen& seen,
                              const Eigen::Matrix3d& expected) {
    if constexpr (std::is_same_v<Measurement, SeenSun>) {
      const Eigen::Vector3d towards = (measurement.body - seen.off).normalized();
      const Eigen::Vector3d first = towards.unitOrthogonal();
      // The turn of the attitude about the one axis moves the direction along the other.
      Eigen::Matrix<double, 2, 3> across;
      across.row(0) = towards.cross(first);
      across.row(1) = -first;
      Residual residual{.freedom = 2};
      residual.value.template head<2>() = across * seen.off;
      residual.sigma.template head<2>() =
          (across * expected * across.transpose()).diagonal().cwiseSqrt();
      return residual;
    } else {
      return {.freedom = 3, .value = seen.off, .sigma = expected.diagonal().cwiseSqrt()};
    }
  }
};

}  // namespace spindrift
