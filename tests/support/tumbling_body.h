/// @file
/// A body of the ground model that tumbles freely in a low orbit, and its magnetometer in the field
/// of IGRF-14. Body and magnetometer may differ from the mission file.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/ground_model/dynamics/disturbances.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"
#include "pipelines/three_axis/unscented/gukf.h"
#include "services/mission/igrf.h"
#include "tests/support/low_orbit.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing {

inline constexpr double kFieldNoise_nt = 100.0;
/// Two revolutions at 650 km.
inline constexpr double kTwoOrbits_s = 11'700.0;

inline const Eigen::Vector3d kTumblingMoments_kg_m2{0.6, 1.2, 1.12};
inline constexpr double kTumblingTorqueNoise_nm_rts = 1e-7;

/// How far body and magnetometer are off the mission file.
struct TumblingErrors {
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  ///< As fractions.
  Eigen::Vector3d mounting_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_nt = Eigen::Vector3d::Zero();
  Eigen::Vector3d torque_nm = Eigen::Vector3d::Zero();
  double late_s = 0.0;  ///< How much later than the time tag the field is measured.
};

/// One standard deviation of these errors in the mission file, each component; 0: exact.
struct TumblingPrior {
  double moments = 0.0;
  double mounting_rad = 0.0;
  double bias_nt = 0.0;
  double torque_nm = 0.0;
};

inline GukfModel tumbling_model(const TumblingPrior& prior) {
  GukfModel model{.inertia_kg_m2 = kTumblingMoments_kg_m2.asDiagonal(),
                  .torque_sigma_nm = prior.torque_nm,
                  .torque_noise_nm_rts = kTumblingTorqueNoise_nm_rts};
  const auto set = [&](int first, double sigma) {
    model.alignment.diagonal().segment<3>(first).setConstant(sigma * sigma);
  };
  set(InertiaError, prior.moments);
  set(MagnetometerError, prior.mounting_rad);
  set(MagnetometerBiasError, prior.bias_nt);
  return model;
}

inline const MainFieldModel& igrf14() {
  static const MainFieldModel model = igrf().value();
  return model;
}

class TumblingBody {
 public:
  /// @param most_rad_s The rate has any direction and up to this size.
  TumblingBody(std::mt19937_64& rng, double most_rad_s, const TumblingErrors& errors)
      : rng_{rng},
        errors_{errors},
        orbit_{low_orbit(at_s(0.0),
                         std::uniform_real_distribution<double>{0.0, 2.0 * std::numbers::pi}(rng))},
        body_{RigidBody::make((kTumblingMoments_kg_m2.array() * (1.0 + errors.moments.array()))
                                  .matrix()
                                  .asDiagonal())
                  .value()},
        state_{.q_icrf_body = any_attitude(rng),
               .rate_body_rad_s = std::uniform_real_distribution<double>{0.0, most_rad_s}(
                                      rng)*normal_vector(rng, 1.0)
                                      .normalized()} {}

  /// Moves the body on in steps of a second or less, each with a random torque and that of the
  /// Earth's gravity at its middle.
  void advance(double dt_s) {
    const int steps = static_cast<int>(std::ceil(dt_s));
    const double step_s = dt_s / steps;
    for (int step = 0; step < steps; ++step) {
      const Eigen::Quaterniond midway =
          state_.q_icrf_body * quaternion_by(0.5 * step_s * state_.rate_body_rad_s);
      const Eigen::Vector3d torque_nm =
          errors_.torque_nm +
          gravity_gradient_nm(body_.inertia_kg_m2(),
                              midway.conjugate() * position_icrf_km(t_s_ + 0.5 * step_s)) +
          normal_vector(rng_, kTumblingTorqueNoise_nm_rts / std::sqrt(step_s));
      state_ = body_.after(state_, {.external_nm = torque_nm}, step_s);
      t_s_ += step_s;
    }
  }

  SeenField field() {
    const Eigen::Vector3d true_nt =
        state_.q_icrf_body.conjugate() * field_icrf_nt_at(t_s_ + errors_.late_s);
    return {.body_nt = rotation_by(errors_.mounting_rad) * true_nt + errors_.bias_nt +
                       normal_vector(rng_, kFieldNoise_nt),
            .ref_icrf_nt = field_icrf_nt_at(t_s_),
            .noise_nt = kFieldNoise_nt};
  }

  const BodyState& state() const { return state_; }
  double t_s() const { return t_s_; }
  Eigen::Vector3d position_icrf_km(double t_s) const {
    return orbit_.at(at_s(t_s)).value().position_icrf_km;
  }

 private:
  Eigen::Vector3d field_icrf_nt_at(double t_s) {
    return field_icrf_nt(igrf14(), at_s(t_s), position_icrf_km(t_s), earth_).value();
  }

  std::mt19937_64& rng_;
  TumblingErrors errors_;
  Orbit orbit_;
  RigidBody body_;
  BodyState state_;
  TurningEarth earth_;
  double t_s_ = 0.0;
};

/// Draws errors as the prior states them; the torque is constant.
inline TumblingErrors drawn(const TumblingPrior& prior, std::mt19937_64& rng) {
  TumblingErrors errors{.moments = normal_vector(rng, prior.moments),
                        .mounting_rad = normal_vector(rng, prior.mounting_rad),
                        .bias_nt = normal_vector(rng, prior.bias_nt),
                        .torque_nm = normal_vector(rng, prior.torque_nm)};
  return errors;
}

}  // namespace spindrift::testing
