#include "tests/support/steady_residuals.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "pipelines/ephemeris/earth_pole.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// The sky is good for a minute.
constexpr double kSky_s = 30.0;

/// Takes out what a tilt of the axis, phase, rate and drift explain, by least squares.
void settle(std::vector<SteadyResidual>& residuals) {
  const auto edges = static_cast<Eigen::Index>(residuals.size());
  Eigen::Matrix<double, Eigen::Dynamic, 5> columns(edges, 5);
  Eigen::VectorXd off(edges);
  for (Eigen::Index i = 0; i < edges; ++i) {
    const SteadyResidual& residual = residuals[static_cast<std::size_t>(i)];
    const double t = residual.t_s / residuals.back().t_s;
    columns.row(i) << residual.expected.phase_per_rotation.head<2>().transpose(), 1.0, t, t * t;
    columns.row(i) /= residual.sigma_rad;
    off[i] = residual.off_rad / residual.sigma_rad;
  }
  const Eigen::VectorXd fit =
      (columns.transpose() * columns).ldlt().solve(columns.transpose() * off);
  const Eigen::VectorXd rest = off - columns * fit;
  for (Eigen::Index i = 0; i < edges; ++i) {
    SteadyResidual& residual = residuals[static_cast<std::size_t>(i)];
    residual.off_rad = rest[i] * residual.sigma_rad;
  }
}

}  // namespace

SpinTruth steady_truth() {
  const SpinningBody body = body_across_the_earth();
  const auto beam = [](const InfraredSensor& sensor) {
    return TrueInfrared{.mount_angle_rad = sensor.mount_angle_rad,
                        .azimuth_rad = sensor.azimuth_rad};
  };
  return {.start = kTransferStart,
          .motion = {.axis_icrf = body.axis_icrf,
                     .rate_rad_s = body.rate_rad_s,
                     .rate_drift_rad_s2 = 0.0,
                     .first_azimuth_rad = 1.0},
          .sun_sensor = body.config.sun_sensor,
          .north = beam(*body.config.north),
          .south = beam(*body.config.south),
          .horizon = infrared_horizon(body.config.horizon, earth_pole_icrf(kTransferStart))};
}

Turning turning(const SpinTruth& truth, double duration_s) {
  const Orbit orbit = orbit_across_the_earth();
  return {.truth = truth, .edges = SpinEdges{truth, orbit}.until(duration_s).value()};
}

std::vector<SteadyResidual> steady_residuals(const Turning& turning, const PulseNoise& noise,
                                             std::mt19937_64& rng) {
  const SpinMotion& motion = turning.truth.motion;
  const Orbit orbit = orbit_across_the_earth();
  const SpinConfig config = usual_config();
  Eigen::Matrix3d R_spin_icrf;
  R_spin_icrf << tangent_basis(motion.axis_icrf).transpose(), motion.axis_icrf.transpose();
  std::normal_distribution<double> normal;
  std::vector<SteadyResidual> residuals;
  double sky_s = 0.0;
  Sky sky = sky_at(orbit, turning.truth.start);
  for (const TrueEdge& edge : turning.edges) {
    const double sigma_s = edge_sigma_s(noise, edge.channel);
    const double t_s = edge.t_s + sigma_s * normal(rng);
    if (t_s > sky_s + kSky_s) {
      sky_s = t_s;
      sky = sky_at(orbit, shifted(turning.truth.start, t_s));
    }
    const auto expected =
        predict_edge(config, sky, R_spin_icrf,
                     {.t = shifted(turning.truth.start, t_s), .channel = edge.channel});
    if (expected) {
      const double azimuth_rad = motion.azimuth_rad(t_s);
      residuals.push_back({.channel = edge.channel,
                           .t_s = t_s,
                           .turns = azimuth_rad / kTurn_rad,
                           .off_rad = wrapped_rad(azimuth_rad - expected->phase_rad),
                           .sigma_rad = sigma_s * motion.rate_rad_s,
                           .expected = *expected});
    }
  }
  settle(residuals);
  return residuals;
}

}  // namespace spindrift::testing
