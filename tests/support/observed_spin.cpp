#include "tests/support/observed_spin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift::testing {

Sky sky_at(const Orbit& orbit, TaiTime t) {
  const OrbitState spacecraft = orbit.at(t).value();
  return {.t = t,
          .spacecraft = spacecraft,
          .sun_icrf = ApparentSun{}.direction_icrf(t, spacecraft),
          .earth_pole_icrf = earth_pole_icrf(t)};
}

std::vector<ObservedRevolution> observed(const SpinConfig& config, const Orbit& orbit,
                                         std::vector<Pulse> pulses) {
  std::sort(pulses.begin(), pulses.end());
  Associator associator{config};
  std::vector<ObservedRevolution> seen;
  const auto keep = [&](const Association& association) {
    for (const Revolution& revolution : association.closed) {
      const auto* const first = std::find_if(revolution.edges.begin(), revolution.edges.end(),
                                             [](const auto& edge) { return edge.has_value(); });
      seen.push_back({.revolution = revolution, .sky = sky_at(orbit, **first)});
    }
  };
  for (const Pulse& pulse : pulses) {
    keep(associator.push(pulse));
  }
  keep(associator.finish());
  return seen;
}

Orbit transfer_orbit() {
  return Orbit{KeplerOrbit::make({.epoch = kTransferStart,
                                  .semi_major_axis_km = 24400.0,
                                  .eccentricity = 0.73,
                                  .inclination_rad = 27.0 * kRadPerDeg,
                                  .raan_rad = 0.5,
                                  .argument_of_perigee_rad = 3.0,
                                  .mean_anomaly_rad = 0.35})
                   .value()};
}

std::vector<Pulse> noisy_pulses(const SpinningBody& body, const std::vector<Edge>& edges,
                                std::mt19937_64& rng) {
  return pulses_from(edges, kTransferStart, body.config.noise, rng);
}

SunEarthEphemeris seen_from(const Orbit& orbit, const Eigen::Vector3d& horizon_km) {
  const auto at = [orbit](double t_s) { return orbit.at(shifted(kTransferStart, t_s)).value(); };
  return {
      .sun_icrf =
          [at, sun = ApparentSun{}](double t_s) mutable {
            return sun.direction_icrf(shifted(kTransferStart, t_s), at(t_s));
          },
      .earth_icrf_km = [at](double t_s) -> Eigen::Vector3d { return -at(t_s).position_icrf_km; },
      .horizon_km = horizon_km};
}

Orbit transfer_with_node(double raan_deg) {
  return Orbit{KeplerOrbit::make({.epoch = kTransferStart,
                                  .semi_major_axis_km = 24400.0,
                                  .eccentricity = 0.73,
                                  .inclination_rad = 28.5 * kRadPerDeg,
                                  .raan_rad = raan_deg * kRadPerDeg,
                                  .argument_of_perigee_rad = 178.0 * kRadPerDeg,
                                  .mean_anomaly_rad = 30.0 * kRadPerDeg})
                   .value()};
}

Orbit orbit_across_the_earth() { return transfer_with_node(300.0); }

SpinningBody body_across_the_earth() {
  return {
      .axis_icrf = direction_icrf({.ra_rad = 100.0 * kRadPerDeg, .dec_rad = -55.0 * kRadPerDeg}),
      .rate_rad_s = kTurn_rad,
      .first_turn_rad = 0.0,
      .config = usual_config()};
}

SpinningBody random_body(const SunEarthEphemeris& around, double tilt_rad, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  const Eigen::Vector3d sun_icrf = around.sun_icrf(0.0);
  const Eigen::Vector3d earth_icrf = around.earth_icrf_km(0.0).normalized();
  while (true) {
    const double roll_rad = kTurn_rad * uniform(rng);
    const double tilted_rad = (2.0 * uniform(rng) - 1.0) * tilt_rad;
    const Eigen::Vector3d across =
        Eigen::AngleAxisd{roll_rad, earth_icrf} * earth_icrf.unitOrthogonal();
    const Eigen::Vector3d axis = Eigen::AngleAxisd{tilted_rad, across.cross(earth_icrf)} * across;
    if (std::abs(angle_between_rad(axis, sun_icrf) - kQuarter_rad) < 25.0 * kRadPerDeg) {
      return {.axis_icrf = axis,
              .rate_rad_s = kTurn_rad * (0.95 + 0.1 * uniform(rng)),
              .first_turn_rad = kTurn_rad * uniform(rng),
              .config = usual_config()};
    }
  }
}

SpinFix made_fix(const Eigen::Vector3d& axis_icrf, const Eigen::Matrix2d& covariance_rad2) {
  return {.revolution = 0,
          .t = {},
          .geometry_case = 1,
          .axis_icrf = axis_icrf,
          .covariance_rad2 = covariance_rad2,
          .alternates = {},
          .resolution = Resolution::Geometry,
          .norm = 1.0,
          .accepted = true};
}

SpinFix drawn_fix(const Eigen::Vector3d& axis_icrf, double sigma_rad, std::mt19937_64& rng) {
  std::normal_distribution<double> normal{0.0, sigma_rad};
  const Eigen::Vector2d off{normal(rng), normal(rng)};
  return made_fix((axis_icrf + tangent_basis(axis_icrf) * off).normalized(),
                  sigma_rad * sigma_rad * Eigen::Matrix2d::Identity());
}

Eigen::Vector2d error_rad(const Eigen::Vector3d& estimated_icrf, const Eigen::Vector3d& true_icrf) {
  return tangent_basis(estimated_icrf).transpose() * (true_icrf - estimated_icrf);
}

}  // namespace spindrift::testing
