#include "pipelines/reconstruction/history.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipelines/reconstruction/torque_free_arc.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Returns the derivative of the rate's error, which is the measured rate minus the bias.
PerTurnError rate_per_error(const Eigen::Vector3d& rate_body_rad_s) {
  PerTurnError slopes;
  slopes << -Matrix3d::Identity(), -measured_per_gyro_error(rate_body_rad_s);
  return slopes;
}

std::vector<ReconstructedAttitude> attitudes_of(const Observations& all,
                                                const NodeEstimates& nodes) {
  std::vector<ReconstructedAttitude> attitudes;
  const SharedErrors& shared = nodes.shared;
  const Eigen::Matrix<double, kTurnErrors, kTurnErrors> of_gyro =
      shared.total.block<kTurnErrors, kTurnErrors>(SharedGyroBias, SharedGyroBias);
  for (std::size_t i = 0; i < nodes.times_s.size(); ++i) {
    const Eigen::Vector3d rate_body_rad_s = all.rates.rate_at(nodes.times_s[i]) - nodes.bias_rad_s;
    const PerShared& slopes = nodes.per_shared[i];
    const auto estimated = slopes.leftCols<kEstimatedErrors>();
    const PerTurnError rate_slopes = rate_per_error(rate_body_rad_s);
    attitudes.push_back(
        {.t = shifted(all.origin, nodes.times_s[i]),
         .q_icrf_body = nodes.q_icrf_body[i],
         .rate_body_rad_s = rate_body_rad_s,
         .covariance_rad2 = nodes.own_rad2[i] + slopes * shared.total * slopes.transpose(),
         .noise_covariance_rad2 =
             nodes.own_rad2[i] + estimated * shared.noise * estimated.transpose(),
         .rate_covariance_rad2_s2 = rate_slopes * of_gyro * rate_slopes.transpose()});
    attitudes.back().rate_covariance_rad2_s2.diagonal().array() +=
        std::pow(nodes.gyro_noise_rad_s, 2);
  }
  attitudes.front().rate_covariance_rad2_s2.diagonal().array() +=
      all.rates.start_variance_rad2_s2();
  return attitudes;
}

/// Returns the joint covariance of rotation and rate at T2.
Matrix6d start_covariance(const Observations& all, const NodeEstimates& nodes,
                          const SharedCovariance& shared) {
  Eigen::Matrix<double, 6, kSharedErrors> slopes = Eigen::Matrix<double, 6, kSharedErrors>::Zero();
  slopes.topRows<3>() = nodes.per_shared.front();
  slopes.bottomRows<3>().middleCols<kTurnErrors>(SharedGyroBias) =
      rate_per_error(all.rates.rate_at(0.0) - nodes.bias_rad_s);
  Matrix6d covariance = slopes * shared * slopes.transpose();
  covariance.topLeftCorner<3, 3>() += nodes.own_rad2.front();
  covariance.diagonal().tail<3>().array() +=
      std::pow(nodes.gyro_noise_rad_s, 2) + all.rates.start_variance_rad2_s2();
  return covariance;
}

/// Returns at most 60 attitudes from T1 to T2, T2 excluded, at least one second apart; empty if T1
/// is T2.
std::vector<ReconstructedAttitude> arc_to_separation(const ReconstructionRequest& request,
                                                     const Observations& all,
                                                     const NodeEstimates& nodes) {
  const double arc_s = seconds_between(all.events.front().t, all.origin);
  const double points = std::clamp(std::floor(arc_s), 1.0, 60.0);
  const BodyState control_on{nodes.q_icrf_body.front(), all.rates.rate_at(0.0) - nodes.bias_rad_s};
  const std::optional<Inertia>& inertia = request.sensors.inertia;
  const auto kg_m2 = inertia ? std::optional{inertia->kg_m2} : std::nullopt;
  // Unmodelled torques, and the nutation of a body of unknown inertia.
  Eigen::Vector3d acceleration_rad_s2 = Eigen::Vector3d::Constant(request.disturbance_rad_s2);
  if (!inertia) {
    acceleration_rad_s2 += unknown_acceleration_rad_s2(control_on.rate_body_rad_s);
  }
  const ArcCovariance total{.start = start_covariance(all, nodes, nodes.shared.total),
                            .inertia_fraction = inertia ? inertia->sigma_fraction : 0.0,
                            .acceleration_rad_s2 = acceleration_rad_s2};
  SharedCovariance of_noise = SharedCovariance::Zero();
  of_noise.topLeftCorner<kEstimatedErrors, kEstimatedErrors>() = nodes.shared.noise;
  const ArcCovariance noise{.start = start_covariance(all, nodes, of_noise),
                            .inertia_fraction = 0.0,
                            .acceleration_rad_s2 = acceleration_rad_s2};
  ArcState at = start_of_arc(control_on);
  std::vector<ReconstructedAttitude> attitudes;
  for (double i = 1.0; arc_s > 0.0 && i <= points; ++i) {
    at = torque_free_arc(at, kg_m2, -arc_s / points);
    const Matrix6d known = covariance_of(at.slopes, total);
    attitudes.push_back(
        {.t = shifted(all.origin, -arc_s * i / points),
         .q_icrf_body = at.body.q_icrf_body,
         .rate_body_rad_s = at.body.rate_body_rad_s,
         .covariance_rad2 = known.topLeftCorner<3, 3>(),
         .noise_covariance_rad2 = covariance_of(at.slopes, noise).topLeftCorner<3, 3>(),
         .rate_covariance_rad2_s2 = known.bottomRightCorner<3, 3>()});
  }
  std::reverse(attitudes.begin(), attitudes.end());
  return attitudes;
}

}  // namespace

History history_of(const ReconstructionRequest& request, const Observations& all,
                   const NodeEstimates& nodes) {
  const std::vector<ReconstructedAttitude> measured = attitudes_of(all, nodes);
  History history{.attitudes = arc_to_separation(request, all, nodes), .events = {0}};
  const std::size_t arc = history.attitudes.size();
  history.attitudes.insert(history.attitudes.end(), measured.begin(), measured.end());
  for (auto event = all.events.begin() + 1; event != all.events.end(); ++event) {
    const auto node =
        std::lower_bound(nodes.times_s.begin(), nodes.times_s.end(), all.seconds_of(event->t));
    history.events.push_back(arc +
                             static_cast<std::size_t>(std::distance(nodes.times_s.begin(), node)));
  }
  return history;
}

std::vector<ReconstructedEvent> events_of(const Observations& all, const History& history) {
  std::vector<ReconstructedEvent> events;
  for (std::size_t i = 0; i < all.events.size(); ++i) {
    events.push_back({.event = all.events[i].event,
                      .found = all.events[i].found,
                      .attitude = history.attitudes[history.events[i]]});
  }
  return events;
}

}  // namespace spindrift
