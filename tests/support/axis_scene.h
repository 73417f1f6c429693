/// @file
/// A scene with one revolution of a spinning body, with Sun and Earth at rest, for tests of what
/// the revolution says about the axis.

#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/sky.h"
#include "tests/support/lone_fix.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

/// Holds a body that spins about `axis_icrf` with one turn in six seconds, so that a nanosecond is
/// 1e-9 rad of spin phase.
struct AxisScene {
  Eigen::Vector3d sun_icrf = Eigen::Vector3d{1.0, 0.2, 0.1}.normalized();
  Eigen::Vector3d earth_icrf = Eigen::Vector3d{0.3, 1.0, -0.02}.normalized();
  Eigen::Vector3d axis_icrf = Eigen::Vector3d{0.1, -0.05, 1.0}.normalized();
  double rate_rad_s = 2.0 * std::numbers::pi / 6.0;
  double first_turn_rad = 0.1;
  SpinConfig config = usual_config();
  TaiTime start = tai_from_ns(1'795'143'637'000'000'000);
  /// True horizon of the Earth; `config` holds the one assumed.
  HorizonModel earth = HorizonModel::Sphere;

  static constexpr double kRange_km = 16000.0;

  SunEarthDirections sun_earth() const {
    return {.sun_icrf = sun_icrf,
            .earth_icrf = earth_icrf,
            .disc_rad = std::asin(6418.137 / kRange_km),
            .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  }
  SunEarthEphemeris around() const {
    SunEarthEphemeris around = at_rest(sun_icrf, kRange_km * earth_icrf);
    around.horizon_km = usual_horizon_km(earth);
    return around;
  }
  Revolution seen() const { return seen_among(around()); }
  Revolution seen_among(const SunEarthEphemeris& around) const {
    return revolution_seen({.axis_icrf = axis_icrf,
                            .rate_rad_s = rate_rad_s,
                            .first_turn_rad = first_turn_rad,
                            .config = config},
                           around, start);
  }
  /// Returns the revolution as seen while the Earth moves across the line of sight from `start` on.
  Revolution seen_while_earth_moves(const Eigen::Vector3d& motion_icrf_s) const {
    SunEarthEphemeris moving = around();
    moving.earth_icrf_km = [=, this](double t_s) -> Eigen::Vector3d {
      return kRange_km * (earth_icrf + t_s * motion_icrf_s);
    };
    return seen_among(moving);
  }
  SunEarthDirections sightlines_while_earth_moves(const Eigen::Vector3d& motion_icrf_s) const {
    SunEarthDirections moving = sun_earth();
    moving.t_earth = start;
    moving.earth_motion_icrf_s = motion_icrf_s;
    return moving;
  }
  tl::expected<SpinFix, NoCandidates> fix(const std::set<SpinQuantity>& left_out = {}) const {
    return lone_fix(config, seen(), left_out, sun_earth());
  }
  RevolutionMeasurements measured(const std::set<SpinQuantity>& left_out = {}) const {
    return measured_without(config, seen(), left_out);
  }
  double off_rad(const Eigen::Vector3d& other_icrf) const {
    return angle_between_rad(other_icrf, axis_icrf);
  }
};

/// Returns a scene with the spin axis tilted against the Earth's, so that the flattening is
/// oblique, and the Sun well aside.
inline AxisScene tilted_scene(double tilt_deg, double earth_angle_deg, HorizonModel earth) {
  AxisScene scene{.earth = earth};
  scene.config.horizon.model = earth;
  scene.axis_icrf =
      Eigen::AngleAxisd{tilt_deg * kRadPerDeg, Eigen::Vector3d::UnitX()} * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d side = Eigen::AngleAxisd{0.3, scene.axis_icrf} * Eigen::Vector3d::UnitX();
  const auto from_axis = [&](double angle_rad) -> Eigen::Vector3d {
    return Eigen::AngleAxisd{angle_rad, scene.axis_icrf.cross(side)} * scene.axis_icrf;
  };
  scene.earth_icrf = from_axis(earth_angle_deg * kRadPerDeg);
  scene.sun_icrf = Eigen::AngleAxisd{1.2, scene.axis_icrf} * from_axis(1.8);
  return scene;
}

// Tolerance for exact edges: 1 ns of an edge, amplified by the geometry (by 5.7 for the earth angle
// of two beams 10 deg apart, by 33 for one beam with |Delta| = 0.03).
inline constexpr double kExact_rad = 1e-7;

/// Returns the revolution with Gaussian noise added to every edge.
inline Revolution noisy(const AxisScene& scene, Revolution revolution, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const bool sun = channel < index_of(PulseChannel::NorthIn);
    const double sigma_s = sun ? scene.config.noise.sun_s : scene.config.noise.infrared_s;
    if (auto& edge = revolution.edges.at(channel)) {
      edge = shifted(*edge, sigma_s * normal(rng));
    }
  }
  return revolution;
}

}  // namespace spindrift::testing
