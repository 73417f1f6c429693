#include "pipelines/three_axis/attitude_gates.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>

#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

/// Longest time after a measured Sun for which it confirms what the field says.
constexpr double kSunHolds_s = 10.0;

/// Returns the angle of a measured direction to that expected at the nominal attitude.
std::optional<double> off_nominal_deg(const std::optional<NominalAttitude>& nominal,
                                      const Expected<OrbitState>& spacecraft,
                                      const Eigen::Vector3d& body, const Eigen::Vector3d& icrf) {
  if (!nominal || body.isZero(0.0)) {
    return std::nullopt;
  }
  const auto q_icrf_body = q_icrf_nominal(*nominal, spacecraft);
  return q_icrf_body ? std::optional{degrees(angle_between_rad(*q_icrf_body * body, icrf))}
                     : std::nullopt;
}

}  // namespace

Expected<Eigen::Quaterniond> q_icrf_nominal(const NominalAttitude& nominal,
                                            const Expected<OrbitState>& spacecraft) {
  if (nominal.frame == NominalAttitude::Frame::Icrf) {
    return nominal.q_frame_body;
  }
  return spacecraft.and_then(orbit_frame).map([&](const Eigen::Quaterniond& q_icrf_orbit) {
    return Eigen::Quaterniond{q_icrf_orbit * nominal.q_frame_body};
  });
}

void AttitudeGates::see_sun(TaiTime t, const Eigen::Vector3d& sun_body,
                            const Eigen::Vector3d& sun_icrf,
                            const Expected<OrbitState>& spacecraft) {
  if (const auto off_deg = off_nominal_deg(nominal_, spacecraft, sun_body, sun_icrf)) {
    by_sun_.update(t, *off_deg > rule_of(Gate::Lost).threshold);
    sun_ = SunAngle{.t = t, .deg = *off_deg};
  }
}

void AttitudeGates::see_field(TaiTime t, const Eigen::Vector3d& field_body,
                              const Eigen::Vector3d& field_icrf,
                              const Expected<OrbitState>& spacecraft, Products& out) {
  const auto off_deg = off_nominal_deg(nominal_, spacecraft, field_body, field_icrf);
  if (!off_deg) {
    return;
  }
  const bool has_sun = sun_ && elapsed_s(sun_->t, t) <= kSunHolds_s;
  field_ = FieldSaid{.t = t, .off_deg = *off_deg, .certain = has_sun && by_sun_.is_open()};
  std::vector<NamedValue> more{{"certain", std::int64_t{field_->certain}}};
  if (has_sun) {
    more.push_back({"sun_deg", sun_->deg});
  }
  update(t, Gate::Lost, *off_deg, *off_deg > rule_of(Gate::Lost).threshold, std::move(more), out);
}

void AttitudeGates::see(const AttitudeEstimate& estimate, const Expected<OrbitState>& spacecraft,
                        Products& out) {
  if (!nominal_ || estimate.assessment.quality == Quality::Lost) {
    return;
  }
  const auto q_icrf_body = q_icrf_nominal(*nominal_, spacecraft);
  if (!q_icrf_body) {
    return;
  }
  const double off_deg = degrees(angle_between_rad(*q_icrf_body, estimate.q_icrf_body));
  update(estimate.t, Gate::Reached, off_deg, off_deg < rule_of(Gate::Reached).threshold,
         {{"sigma_deg", degrees(estimate.sigma_rad())}}, out);
}

void AttitudeGates::see_innovation(const Observation& field, Products& out) {
  const double off_nt = field.residual.value.norm();
  update(field.t, Gate::Usable, off_nt, off_nt < rule_of(Gate::Usable).threshold, {}, out);
}

void AttitudeGates::see(const WinnerReading& winner, Products& out) {
  const double mean = mean_nis(winner);
  const double sigma_deg = degrees(winner.sigma_rad);
  const bool is_hit = winner.nis < rule_of(Gate::Safe).threshold && mean < kMostMeanNis &&
                      sigma_deg < kMostSigma_deg && winner.lead_nats >= kLeastLead_nats;
  std::vector<NamedValue> more{{"mean_nis", mean}, {"sigma_deg", sigma_deg}};
  if (std::isfinite(winner.lead_nats)) {
    more.push_back({"lead_nats", winner.lead_nats});
  }
  update(winner.t, Gate::Safe, winner.nis, is_hit, std::move(more), out);
}

double AttitudeGates::mean_nis(const WinnerReading& winner) {
  recent_.push_back({.t = winner.t, .nis = winner.nis});
  while (elapsed_s(recent_.front().t, winner.t) > rule_of(Gate::Safe).seconds) {
    recent_.pop_front();
  }
  const double sum = std::transform_reduce(recent_.begin(), recent_.end(), 0.0, std::plus{},
                                           [](const Nis& one) { return one.nis; });
  return sum / static_cast<double>(recent_.size());
}

void AttitudeGates::update(TaiTime t, Gate gate, double value, bool is_hit,
                           std::vector<NamedValue> more, Products& out) {
  WindowGate& machine = gates_.at(static_cast<std::size_t>(gate));
  if (const auto window = machine.update(t, is_hit)) {
    out.emplace_back(GateTransition{.t = t,
                                    .gate = gate,
                                    .open = machine.is_open(),
                                    .value = value,
                                    .since = window->since,
                                    .hits = window->hits,
                                    .window = window->samples,
                                    .more = std::move(more)});
  }
}

}  // namespace spindrift
