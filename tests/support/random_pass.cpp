#include "tests/support/random_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing {
namespace {

constexpr double kCo2_km = 40.0;
constexpr double kRevolutions = 300.0;

class Draw {
 public:
  explicit Draw(std::mt19937_64& rng) : rng_{rng} {}

  double between(double least, double most) { return least + (most - least) * uniform_(rng_); }
  Eigen::Vector3d direction() {
    return Eigen::Vector3d{normal_(rng_), normal_(rng_), normal_(rng_)}.normalized();
  }

 private:
  std::mt19937_64& rng_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

Orbit random_orbit(Draw& draw) {
  while (true) {
    const auto orbit = KeplerOrbit::make({.epoch = kTransferStart,
                                          .semi_major_axis_km = draw.between(15000.0, 42164.0),
                                          .eccentricity = draw.between(0.0, 0.7),
                                          .inclination_rad = draw.between(0.0, std::numbers::pi),
                                          .raan_rad = draw.between(0.0, kTurn_rad),
                                          .argument_of_perigee_rad = draw.between(0.0, kTurn_rad),
                                          .mean_anomaly_rad = draw.between(0.0, kTurn_rad)});
    if (orbit && orbit->at(kTransferStart)->position_icrf_km.norm() > 9000.0) {
      return Orbit{*orbit};
    }
  }
}

SpinConfig random_config(Draw& draw) {
  SpinConfig config = usual_config();
  config.sun_sensor.slit_cant_rad = draw.between(30.0, 50.0) * kRadPerDeg;
  config.north->mount_angle_rad = draw.between(60.0, 110.0) * kRadPerDeg;
  config.south->mount_angle_rad =
      config.north->mount_angle_rad + draw.between(5.0, 30.0) * kRadPerDeg;
  config.north->azimuth_rad = draw.between(-std::numbers::pi, std::numbers::pi);
  config.south->azimuth_rad = config.north->azimuth_rad + draw.between(-5.0, 5.0) * kRadPerDeg;
  if (draw.between(0.0, 1.0) < 0.5) {
    config.horizon.model = HorizonModel::Ellipsoid;
  }
  return config;
}

/// Returns whether a beam either crosses the Earth well inside its limb or misses it clearly.
bool well_seen_or_not(const std::optional<InfraredSensor>& sensor, double earth_rad,
                      double disc_rad, int& seen) {
  if (!sensor) {
    return true;
  }
  const double mount_rad = sensor->mount_angle_rad;
  const auto chord = predict_chord_rad(mount_rad, earth_rad, disc_rad);
  if (!chord) {
    return std::abs(mount_rad - earth_rad) > disc_rad + 2.0 * kRadPerDeg;
  }
  ++seen;
  return *chord > 8.0 * kRadPerDeg && *chord < 160.0 * kRadPerDeg;
}

bool is_observable_at(const RandomPass& pass, double t_s) {
  const auto& [name, orbit, around, body, dead] = pass;
  const Eigen::Vector3d earth_icrf_km = around.earth_icrf_km(t_s);
  const Eigen::Vector3d sun_icrf = around.sun_icrf(t_s);
  const double sun_earth_rad = angle_between_rad(sun_icrf, earth_icrf_km);
  const double sun_rad = angle_between_rad(body.axis_icrf, sun_icrf);
  const double earth_rad = angle_between_rad(body.axis_icrf, earth_icrf_km);
  const auto disc_rad = earth_disc_half_angle_rad(earth_icrf_km.norm(), kCo2_km);
  if (!disc_rad) {
    return false;
  }
  const double sin_lag = std::tan(body.config.sun_sensor.slit_cant_rad) / std::tan(sun_rad);
  int seen = 0;
  return std::sin(sun_earth_rad) > 0.17 && std::abs(sin_lag) < 0.9 &&
         well_seen_or_not(body.config.north, earth_rad, *disc_rad, seen) &&
         well_seen_or_not(body.config.south, earth_rad, *disc_rad, seen) && seen > 0;
}

bool is_observable(const RandomPass& pass) {
  return is_observable_at(pass, 0.0) &&
         is_observable_at(pass, kRevolutions * kTurn_rad / pass.body.rate_rad_s);
}

bool sees_the_earth(const RandomPass& pass, const std::optional<InfraredSensor>& sensor,
                    double t_s) {
  const Eigen::Vector3d earth_icrf_km = pass.around.earth_icrf_km(t_s);
  const auto disc_rad = earth_disc_half_angle_rad(earth_icrf_km.norm(), kCo2_km);
  const double earth_rad = angle_between_rad(pass.body.axis_icrf, earth_icrf_km);
  return sensor && disc_rad &&
         predict_chord_rad(sensor->mount_angle_rad, earth_rad, *disc_rad).has_value();
}

bool crosses_the_limb(const RandomPass& pass) {
  const double end_s = kRevolutions * kTurn_rad / pass.body.rate_rad_s;
  const SpinConfig& config = pass.body.config;
  return sees_the_earth(pass, config.north, 0.0) != sees_the_earth(pass, config.north, end_s) ||
         sees_the_earth(pass, config.south, 0.0) != sees_the_earth(pass, config.south, end_s);
}

/// Draws whether all channels work or which sensors are missing or dead; returns a description.
std::string draw_channels(Draw& draw, SpinningBody& body, std::vector<PulseChannel>& dead) {
  const double kind = draw.between(0.0, 1.0);
  if (kind < 0.15) {
    body.config.south.reset();
    return "north only";
  }
  if (kind < 0.3) {
    body.config.north.reset();
    return "south only";
  }
  if (kind < 0.45) {
    dead.push_back(PulseChannel::Sun2);
    return "no sun2";
  }
  if (kind < 0.6) {
    dead.push_back(PulseChannel::Sun1);
    return "no sun1";
  }
  return "all channels";
}

RandomPass drawn_pass(Draw& draw) {
  const Orbit orbit = random_orbit(draw);
  SpinningBody body{.axis_icrf = draw.direction(),
                    .rate_rad_s = kTurn_rad / 60.0 * 5.0 * std::pow(40.0, draw.between(0.0, 1.0)),
                    .first_turn_rad = draw.between(0.0, kTurn_rad),
                    .config = random_config(draw)};
  std::vector<PulseChannel> dead;
  const std::string channels = draw_channels(draw, body, dead);
  const bool sphere = body.config.horizon.model == HorizonModel::Sphere;
  const RaDec axis = ra_dec_of(body.axis_icrf);
  const auto mount_deg = [](const std::optional<InfraredSensor>& sensor) {
    return sensor ? sensor->mount_angle_rad / kRadPerDeg : 0.0;
  };
  return {.name = fmt::format("{}, {}, {:.1f} rpm, axis {:.1f} {:.1f} deg, mounted {:.1f} {:.1f}",
                              channels, sphere ? "sphere" : "ellipsoid",
                              body.rate_rad_s * 30.0 / std::numbers::pi, axis.ra_rad / kRadPerDeg,
                              axis.dec_rad / kRadPerDeg, mount_deg(body.config.north),
                              mount_deg(body.config.south)),
          .orbit = orbit,
          .around = seen_from(
              orbit, sphere ? spherical_horizon_km(kCo2_km) : ellipsoidal_horizon_km(kCo2_km)),
          .body = body,
          .dead = dead};
}

}  // namespace

std::vector<Pulse> RandomPass::pulses(double revolutions, std::mt19937_64& rng) const {
  auto edges = edges_between(body, around, 0.0, revolutions * kTurn_rad / body.rate_rad_s);
  std::erase_if(edges, [&](const Edge& edge) {
    return std::find(dead.begin(), dead.end(), edge.channel) != dead.end();
  });
  return noisy_pulses(body, edges, rng);
}

RandomPass random_pass(std::mt19937_64& rng) {
  Draw draw{rng};
  while (true) {
    RandomPass pass = drawn_pass(draw);
    if (is_observable(pass)) {
      return pass;
    }
  }
}

RandomPass pass_across_the_limb(std::mt19937_64& rng) {
  Draw draw{rng};
  while (true) {
    RandomPass pass = drawn_pass(draw);
    if (crosses_the_limb(pass)) {
      return pass;
    }
  }
}

}  // namespace spindrift::testing
