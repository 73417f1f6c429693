#include "pipelines/ground_model/flights/rescue_motion.h"

#include <cmath>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/three_axis/attitude_gates.h"
#include "pipelines/three_axis/unscented/gukf_bank.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

/// The computer on board.
class RescueComputer {
 public:
  /// Steps of the filters in a period, so that they know when a pulse ends.
  static constexpr int kSteps = 5;

  RescueComputer(const RescueTruth& truth, const Thrusters& thrusters, const Orbit& orbit,
                 Chance& chance)
      : truth_{truth},
        fired_{thrusters},
        orbit_{orbit},
        chance_{chance},
        gates_{truth.control.commanded} {}

  /// Runs a period. @return The record of its beginning, with the torque that is commanded.
  /// @return Errors of orbit and field.
  Expected<RescueRecord> run(const ClosedLoop<BodyMotion>& loop, TaiTime t,
                             const OrbitState& spacecraft) {
    const BodyState& body = loop.body().last();
    const auto target = target_at(t, spacecraft);
    if (!target) {
      return Unexpected{target.error()};
    }
    const auto field = field_at(t, spacecraft, body);
    if (!field) {
      return Unexpected{field.error()};
    }
    gates_.see_field(t, field->body_nt, field->ref_icrf_nt, spacecraft, transitions_);
    if (phase_ != RescuePhase::Pointing) {
      follow(t, *field, spacecraft);
    }
    last_field_ = *field;
    decide();
    const Vector3d asked_nm = torque_nm(loop.t_s(), body, *target);
    fired_.command(asked_nm, truth_.control.period_s);
    return RescueRecord{.t_s = loop.t_s(),
                        .phase = phase_,
                        .torque_nm = asked_nm,
                        .off_rad = angle_between_rad(body.q_icrf_body, target->q_icrf_target),
                        .error_rad = bank_ ? std::optional{angle_between_rad(
                                                 bank_->best().q_icrf_body(), body.q_icrf_body)}
                                           : std::nullopt};
  }

 private:
  Expected<AttitudeTarget> target_at(TaiTime t, const OrbitState& spacecraft) const {
    const RescueControl& control = truth_.control;
    return q_icrf_nominal(control.commanded, spacecraft).and_then([&](const auto& now) {
      return q_icrf_nominal(control.commanded, orbit_.at(shifted(t, control.period_s)))
          .map([&](const Eigen::Quaterniond& next) {
            return AttitudeTarget{
                .q_icrf_target = now,
                .rate_target_rad_s = rotation_vector_of(now.conjugate() * next) / control.period_s};
          });
    });
  }

  Expected<SeenField> field_at(TaiTime t, const OrbitState& spacecraft, const BodyState& body) {
    const TrueMagnetometer& magnetometer = truth_.magnetometer;
    return field_icrf_nt(magnetometer.field, t, spacecraft.position_icrf_km, earth_)
        .map([&](const Vector3d& icrf_nt) {
          return SeenField{.body_nt = body.q_icrf_body.conjugate() * icrf_nt +
                                      magnetometer.bias_nt +
                                      chance_.normal_vector(magnetometer.noise_nt),
                           .ref_icrf_nt = icrf_nt,
                           .noise_nt = magnetometer.noise_nt};
        });
  }

  /// Follows the attitude by the field alone, and shows the gates what the filters say.
  void follow(TaiTime t, const SeenField& field, const OrbitState& spacecraft) {
    if (!bank_) {
      bank_.emplace(truth_.filter, last_field_.value(), field, truth_.control.period_s);
      return;
    }
    for (int i = 0; i < kSteps; ++i) {
      const double step_s = truth_.control.period_s / kSteps;
      bank_->propagate(step_s, fired_.step(step_s));
    }
    const UnscentedInnovation said = bank_->innovation(field);
    bank_->update(field);
    const AttitudeEstimate estimate{.t = t,
                                    .q_icrf_body = bank_->best().q_icrf_body(),
                                    .rate_body_rad_s = bank_->best().rate_rad_s(),
                                    .covariance_rad2 = bank_->best().attitude_covariance_rad2(),
                                    .assessment = {.quality = Quality::Converging}};
    gates_.see({.t = t,
                .nis = said.nis,
                .sigma_rad = estimate.sigma_rad(),
                .lead_nats = bank_->lead_nats()},
               transitions_);
    gates_.see(estimate, spacecraft, transitions_);
  }

  void decide() {
    const bool is_safe = gates_.is_open(Gate::Safe);
    if (phase_ == RescuePhase::Pointing) {
      phase_ = gates_.is_open(Gate::Lost) ? RescuePhase::Lost : phase_;
    } else if (!is_safe) {
      phase_ = RescuePhase::Lost;
    } else if (phase_ == RescuePhase::Lost) {
      phase_ = RescuePhase::Controlled;
    } else {
      phase_ = gates_.is_open(Gate::Reached) ? RescuePhase::Reached : RescuePhase::Controlled;
    }
  }

  Vector3d torque_nm(double t_s, const BodyState& body, const AttitudeTarget& target) const {
    const RescueControl& control = truth_.control;
    MeasuredBody known{.q_icrf_body = body.q_icrf_body,
                       .rate_body_rad_s = body.rate_body_rad_s,
                       .momentum_body_nms = Vector3d::Zero(),
                       .sun_body = Vector3d::UnitX()};
    if (phase_ == RescuePhase::Lost || (phase_ == RescuePhase::Pointing && !control.failure)) {
      return Vector3d::Zero();
    }
    if (phase_ != RescuePhase::Pointing) {
      known.q_icrf_body = bank_->best().q_icrf_body();
      known.rate_body_rad_s = bank_->best().rate_rad_s();
    } else if (const double failed_s = t_s - control.failure->t_s; failed_s > 0.0) {
      known.q_icrf_body =
          known.q_icrf_body * quaternion_by(failed_s * control.failure->turns_rad_s);
      known.rate_body_rad_s += control.failure->turns_rad_s;
    }
    return VariableLimitPd{
        .target = target,
        .gains = PdGains::of(control.moments_kg_m2, control.frequency_rad_s, control.damping),
        .moments_kg_m2 = control.moments_kg_m2,
        .torque_nm_most = control.thrusters.torque_nm,
        .rate_rad_s_most = Vector3d::Constant(control.slew_rad_s)}
        .torque_body_nm(known);
  }

  const RescueTruth& truth_;
  Thrusters fired_;  ///< What was commanded for the period before.
  const Orbit& orbit_;
  Chance& chance_;
  TurningEarth earth_;
  AttitudeGates gates_;
  AttitudeGates::Products transitions_;
  RescuePhase phase_ = RescuePhase::Pointing;
  std::optional<SeenField> last_field_;
  std::optional<GukfBank> bank_;
};

}  // namespace

Expected<Rescue> rescue_motion(const RescueTruth& truth, const Orbit& orbit, Chance& chance) {
  const auto thrusters = Thrusters::make(truth.control.thrusters);
  if (!thrusters) {
    return Unexpected{thrusters.error()};
  }
  auto loop = loop_of(truth.body, *thrusters, truth.control.period_s);
  if (!loop) {
    return Unexpected{std::move(loop.error())};
  }
  RescueComputer computer{truth, *thrusters, orbit, chance};
  std::vector<RescueRecord> record;
  std::optional<Error> failed;
  auto flown = fly(*loop, truth.body, orbit, [&](TaiTime t, const OrbitState& spacecraft) {
    auto now = computer.run(*loop, t, spacecraft);
    if (!now) {
      failed = std::move(now.error());
      return Vector3d::Zero().eval();
    }
    record.push_back(*now);
    return now->torque_nm;
  });
  if (failed) {
    return Unexpected{*std::move(failed)};
  }
  return flown.map(
      [&] { return Rescue{.motion = std::move(*loop).body(), .record = std::move(record)}; });
}

RescueOutcome outcome_of(const Rescue& rescue) {
  RescueOutcome outcome{};
  const auto begins = [](std::optional<double>& t_s, const RescueRecord& now) {
    t_s = t_s.value_or(now.t_s);
  };
  for (const RescueRecord& now : rescue.record) {
    if (now.phase == RescuePhase::Lost) {
      begins(outcome.lost_s, now);
    } else if (now.phase == RescuePhase::Controlled) {
      begins(outcome.controlled_s, now);
      outcome.error_at_safe_rad =
          outcome.error_at_safe_rad ? outcome.error_at_safe_rad : now.error_rad;
    } else if (now.phase == RescuePhase::Reached) {
      begins(outcome.reached_s, now);
    }
    outcome.last_off_rad = now.off_rad;
  }
  return outcome;
}

}  // namespace spindrift
