#include "pipelines/spin/sequential/spin_filter.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/edge_use.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/statistics/linear_update.h"

namespace spindrift {
namespace {

enum Component : Eigen::Index { kTiltX, kTiltY, kPhase, kRate, kDrift };

constexpr double kFirstDrift_rad_s2 = kFirstDrift_rpm_h * (kTurn_rad / 60.0) / kHour_s;
// One edge in a thousand is spurious and anywhere on the circle.
const double kLogSpurious = std::log(1e-3 / kTurn_rad);
// The period gives the first rate; ten of its sigmas leave it a hundredth of its weight in the
// filter. The share is added because the period's sigma ignores a drift.
constexpr double kFirstRateSigmas = 10.0;
constexpr double kFirstRateShare = 1e-4;

double square(double x) { return x * x; }

double log_normal_density(double squared_innovation, double variance) {
  return -0.5 * (squared_innovation + std::log(kTurn_rad * variance));
}

}  // namespace

GoodEdges::GoodEdges(const SpinConfig& config, const Revolution& revolution) {
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    const auto t = revolution.good_edge(channel);
    if (t && has_sensor(config, channel)) {
      edges_.at(count_++) = {.t = *t, .channel = channel};
    }
  }
}

double RevolutionObservations::squared_innovations() const {
  double sum = 0.0;
  for (const Observation& edge : independent()) {
    sum += edge.bounded_nis();
  }
  return sum;
}

std::optional<SpinFilter> SpinFilter::about(const Eigen::Vector3d& axis_icrf,
                                            const Eigen::Matrix2d& covariance_rad2,
                                            const SpinConfig& config, const Revolution& revolution,
                                            const Sky& sky) {
  const Eigen::Quaterniond q_icrf_spin = frame_about(axis_icrf);
  const Eigen::Matrix3d R_spin_icrf = q_icrf_spin.conjugate().toRotationMatrix();
  const double rate_rad_s = kTurn_rad / revolution.period.period_s;
  const GoodEdges edges{config, revolution};
  for (const Pulse& edge : edges.span()) {
    const auto predicted = predict_edge(config, sky, R_spin_icrf, edge);
    if (!predicted) {
      continue;
    }
    SpinFilter filter{edge.t, q_icrf_spin, predicted->phase_rad, rate_rad_s};
    // The matrix consists of rotations and reflections, so its inverse is its transpose.
    const Eigen::Matrix2d turned = tangent_from_tilts(q_icrf_spin);
    filter.covariance_.topLeftCorner<2, 2>() = turned.transpose() * covariance_rad2 * turned;
    // The axis may rest on the edge that gives the first phase; this sigma leaves the phase free.
    filter.covariance_(kPhase, kPhase) = square(0.1);
    filter.covariance_(kRate, kRate) = square(
        rate_rad_s * (kFirstRateSigmas * revolution.period.sigma_s / revolution.period.period_s +
                      kFirstRateShare));
    filter.covariance_(kDrift, kDrift) = square(kFirstDrift_rad_s2);
    filter.alignment_ = config.alignment;
    filter.unknown_ = config.alignment;
    return filter;
  }
  return std::nullopt;
}

void SpinFilter::predict(TaiTime t) {
  const double dt_s = seconds_between(t_, t);
  if (!(dt_s > 0.0)) {
    return;
  }
  phase_rad_ = wrapped_rad(phase_rad_ + (rate_rad_s_ + 0.5 * drift_rad_s2_ * dt_s) * dt_s);
  rate_rad_s_ += drift_rad_s2_ * dt_s;
  of_errors_.row(kPhase) += dt_s * (of_errors_.row(kRate) + 0.5 * dt_s * of_errors_.row(kDrift));
  of_errors_.row(kRate) += dt_s * of_errors_.row(kDrift);
  of_considered_.row(kPhase) +=
      dt_s * (of_considered_.row(kRate) + 0.5 * dt_s * of_considered_.row(kDrift));
  of_considered_.row(kRate) += dt_s * of_considered_.row(kDrift);
  covariance_.row(kPhase) += dt_s * (covariance_.row(kRate) + 0.5 * dt_s * covariance_.row(kDrift));
  covariance_.col(kPhase) += dt_s * (covariance_.col(kRate) + 0.5 * dt_s * covariance_.col(kDrift));
  covariance_.row(kRate) += dt_s * covariance_.row(kDrift);
  covariance_.col(kRate) += dt_s * covariance_.col(kDrift);

  // Torques turn a satellite's axis by up to 0.1 deg a day. This random walk makes 0.02 deg a day
  // and 3e-6 deg a second, which no pulse can tell from rest.
  const double axis_rad2 = square(1e-6) * dt_s;
  // Wander beside the uniform drift. A constant rate is known better than the filter's sigma says,
  // but the axis hardly depends on it.
  const double rate_rad2_s2 = square(3e-6) * dt_s;
  // In a day this makes 0.02 rpm/h.
  const double drift_rad2_s4 = square(2e-9) * dt_s;
  covariance_(kTiltX, kTiltX) += axis_rad2;
  covariance_(kTiltY, kTiltY) += axis_rad2;
  // Process noise of rate and drift, integrated over the interval into rate and phase.
  Eigen::Matrix3d wander;
  wander << square(dt_s) * (rate_rad2_s2 / 3.0 + drift_rad2_s4 * square(dt_s) / 20.0),
      dt_s * (rate_rad2_s2 / 2.0 + drift_rad2_s4 * square(dt_s) / 8.0),
      drift_rad2_s4 * square(dt_s) / 6.0, 0.0, rate_rad2_s2 + drift_rad2_s4 * square(dt_s) / 3.0,
      drift_rad2_s4 * dt_s / 2.0, 0.0, 0.0, drift_rad2_s4;
  covariance_.bottomRightCorner<3, 3>() += wander.selfadjointView<Eigen::Upper>();
  t_ = t;
}

RevolutionObservations SpinFilter::update(const SpinConfig& config, const Sky& sky,
                                          std::span<const Pulse> edges, const ChannelNoise& noise) {
  const SpinFilter prior = *this;
  const RevolutionEdges seen{.config = config,
                             .sky = sky,
                             .edges = edges,
                             .noise = noise,
                             .sensors = {config, SensorBiases::Zero()}};
  RevolutionObservations said;
  // There may be no state nearby with all these edges; then the missing edges are left out.
  for (const Missing missing : {Missing::Approached, Missing::LeftOut}) {
    *this = prior;
    for (int pass = 0; pass < kMostLinearisations; ++pass) {
      const Linearised here = update_linearised_here(prior, seen, missing, said);
      // Repeats until linearisations agree: their difference would count as knowledge of directions
      // that no edge measures. Edges of a narrow chord are steep and, squared, curved.
      if (!here.approached && here.moved_rad * square(here.steepest) < kFarFromLinear_rad) {
        return said;
      }
    }
  }
  return said;
}

/// Linearises all edges at the present state, so that their order has no weight. Sun edges, the
/// more precise, come first to the gate.
SpinFilter::Linearised SpinFilter::update_linearised_here(const SpinFilter& prior,
                                                          const RevolutionEdges& seen,
                                                          Missing missing,
                                                          RevolutionObservations& said) {
  const auto& [config, sky, edges, noise, sensors] = seen;
  const Eigen::Matrix3d R_spin_icrf = q_icrf_spin_.conjugate().toRotationMatrix();
  Linearised here;
  said = {};
  covariance_ = prior.covariance_;
  of_errors_ = prior.of_errors_;
  of_considered_ = prior.of_considered_;
  learnt_ = prior.learnt_;
  unknown_ = prior.unknown_;
  Error error = error_of(prior);
  const auto gate_of = [&noise = noise](PulseChannel channel) {
    return square(kGateSigmas) * noise.at(index_of(channel));
  };
  for (const Pulse& edge : edges) {
    const double dt_s = seconds_between(t_, edge.t);
    const double phase_rad = phase_rad_ + (rate_rad_s_ + 0.5 * drift_rad_s2_ * dt_s) * dt_s;
    const double sigma_rad = rate_rad_s_ * edge_sigma_s(config.noise, edge.channel);
    auto predicted = predict_edge(sensors, sky, R_spin_icrf, edge);
    const bool exists = predicted.has_value();
    if (!exists && missing == Missing::Approached) {
      predicted = linearise_by_depth(config, sky, R_spin_icrf, edge, phase_rad, sigma_rad);
    }
    if (!predicted) {
      said.add({.t = edge.t,
                .source = source_of(edge.channel),
                .limit = gate_of(edge.channel),
                .rejected_by = Rejection::Innovation});
      said.log_likelihood += kLogSpurious;
      continue;
    }
    const double by_phase = predicted->phase_per_rotation.z();
    PerConsidered per_considered = PerConsidered::Zero();
    per_considered(static_cast<Eigen::Index>(edge.channel)) = rate_rad_s_;
    per_considered.tail<kSpinAlignmentErrors>() = predicted->phase_per_alignment;
    const Measured measured{
        .edge = edge,
        .residual_rad = phase_rad - predicted->phase_rad,
        .sigma_rad = sigma_rad,
        .slope = Error{predicted->phase_per_rotation.x(), predicted->phase_per_rotation.y(),
                       by_phase, by_phase * dt_s, by_phase * 0.5 * square(dt_s)},
        .per_error = predicted->phase_per_error,
        .per_considered = per_considered};
    if (!work_in(measured, gate_of(edge.channel), error, said)) {
      said.log_likelihood += kLogSpurious;
      continue;
    }
    here.approached = here.approached || !exists;
    here.steepest = std::max(here.steepest, predicted->phase_per_rotation.head<2>().norm());
  }
  correct(error);
  here.moved_rad = error.head<2>().norm();
  return here;
}

/// @return False for an edge beyond the gate, which leaves the state unchanged.
bool SpinFilter::work_in(const Measured& measured, double gate, Error& error,
                         RevolutionObservations& said) {
  using Update = LinearUpdate<5, 1>;
  const Update update{covariance_, measured.slope.transpose(),
                      Update::Noise{square(measured.sigma_rad)}};
  const double variance = update.expected(0, 0);
  const double innovation = wrapped_rad(measured.residual_rad - measured.slope.dot(error));
  // An edge that is late by an angle looks as if the phase were ahead by it.
  const PerConsidered innovation_of_considered =
      measured.slope.transpose() * of_considered_ + measured.per_considered;
  const auto of_alignment = innovation_of_considered.tail<kSpinAlignmentErrors>().eval();
  const auto observed = [&](double off_rad, double total) {
    return Observation{.t = measured.edge.t,
                       .source = source_of(measured.edge.channel),
                       .residual = {.freedom = 1,
                                    .value = {off_rad / rate_rad_s_, 0.0, 0.0},
                                    .sigma = {std::sqrt(total) / rate_rad_s_, 0.0, 0.0}},
                       .nis = square(off_rad) / total,
                       .limit = gate};
  };
  const double left = innovation - of_alignment.dot(learnt_);
  const double left_variance = variance + of_alignment * unknown_ * of_alignment.transpose();
  Observation observation =
      observed(innovation, variance + of_alignment * alignment_ * of_alignment.transpose());
  Observation independent = observed(left, left_variance);
  if (observation.nis > gate) {
    observation.rejected_by = independent.rejected_by = Rejection::Innovation;
  }
  said.add(observation, independent);
  if (observation.rejected_by) {
    return false;
  }
  const Eigen::Matrix<double, 1, kModelErrors> innovation_of_errors =
      measured.slope.transpose() * of_errors_ + measured.per_error;
  const Eigen::Matrix<double, kModelErrors, 1> by_errors =
      innovation_of_errors.transpose() / variance;
  const ConsideredVector by_considered = innovation_of_considered.transpose() / variance;
  of_errors_ -= update.gain * innovation_of_errors;
  of_considered_ -= update.gain * innovation_of_considered;
  said.errors += {.information = by_errors * innovation_of_errors,
                  .score = by_errors * innovation,
                  .considered = {.shared = by_errors * innovation_of_considered,
                                 .own = by_considered * innovation_of_considered,
                                 .score = by_considered * innovation}};
  error += update.gain * innovation;
  covariance_ = update.left_of(covariance_);
  said.log_likelihood += log_normal_density(independent.nis, left_variance);
  learn_alignment(of_alignment, left, left_variance);
  return true;
}

/// @param left Innovation less what is known of the errors. @param variance Its variance.
void SpinFilter::learn_alignment(const Eigen::Matrix<double, 1, kSpinAlignmentErrors>& slope,
                                 double left, double variance) {
  const SpinAlignmentVector shared = unknown_ * slope.transpose();
  learnt_ += shared * (left / variance);
  unknown_ -= shared * shared.transpose() / variance;
}

/// Returns the error of this state if `truth` is true.
SpinFilter::Error SpinFilter::error_of(const SpinFilter& truth) const {
  const Eigen::AngleAxisd turn{q_icrf_spin_.conjugate() * truth.q_icrf_spin_};
  const Eigen::Vector3d turn_rad = turn.angle() * turn.axis();
  return Error{turn_rad.x(), turn_rad.y(), wrapped_rad(truth.phase_rad_ - phase_rad_),
               truth.rate_rad_s_ - rate_rad_s_, truth.drift_rad_s2_ - drift_rad_s2_};
}

void SpinFilter::correct(const Error& error) {
  const Eigen::Vector3d tilt_rad{error[kTiltX], error[kTiltY], 0.0};
  const double angle_rad = tilt_rad.norm();
  if (angle_rad > 0.0) {
    q_icrf_spin_ = (q_icrf_spin_ * Eigen::AngleAxisd{angle_rad, tilt_rad / angle_rad}).normalized();
  }
  phase_rad_ = wrapped_rad(phase_rad_ + error[kPhase]);
  rate_rad_s_ += error[kRate];
  drift_rad_s2_ += error[kDrift];
}

Eigen::Matrix2d SpinFilter::axis_covariance_rad2() const {
  const Eigen::Matrix2d turned = tangent_from_tilts(q_icrf_spin_);
  return turned * covariance_.topLeftCorner<2, 2>() * turned.transpose();
}

Eigen::Matrix<double, 2, kModelErrors> SpinFilter::axis_of_errors() const {
  return tangent_from_tilts(q_icrf_spin_) * of_errors_.topRows<2>();
}

Eigen::Matrix2d SpinFilter::considered_rad2(const ConsideredPrior& prior) const {
  const Eigen::Matrix<double, 2, kSpinConsidered> moved =
      tangent_from_tilts(q_icrf_spin_) * of_considered_.topRows<2>();
  return covariance_of_moved(moved, prior);
}

Eigen::Matrix<double, 3, kSpinAlignmentErrors> SpinFilter::axis_of_alignment_icrf() const {
  return tangent_basis(axis_icrf()) * tangent_from_tilts(q_icrf_spin_) *
         of_considered_.topRightCorner<2, kSpinAlignmentErrors>();
}

double SpinFilter::rate_alignment_rad2_s2() const {
  const auto of_rate = of_considered_.row(kRate).tail<kSpinAlignmentErrors>().eval();
  return of_rate * alignment_ * of_rate.transpose();
}

double SpinFilter::rate_sigma_rad_s() const { return std::sqrt(covariance_(kRate, kRate)); }
double SpinFilter::phase_sigma_rad() const { return std::sqrt(covariance_(kPhase, kPhase)); }

}  // namespace spindrift
