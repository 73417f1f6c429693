/// @file
/// A pass cut into revolutions, each with its Sun and Earth directions, as input of the sequential
/// filter.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/association/association.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sky.h"
#include "tests/support/normalised_square.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

struct ObservedRevolution {
  Revolution revolution;
  Sky sky;
};

/// Returns the revolutions that the associator finds in the pulses.
std::vector<ObservedRevolution> observed(const SpinConfig& config, const Orbit& orbit,
                                         std::vector<Pulse> pulses);

Sky sky_at(const Orbit& orbit, TaiTime t);

/// Epoch of transfer_orbit(), which starts 2.5 Earth radii up and climbing.
inline const TaiTime kTransferStart = tai_from_ns(1'795'143'637'000'000'000);
Orbit transfer_orbit();

/// Returns Sun and Earth as seen from the orbit, ICRF; time is counted from `kTransferStart`.
SunEarthEphemeris seen_from(const Orbit& orbit,
                            const Eigen::Vector3d& horizon_km = spherical_horizon_km(40.0));

/// Returns the edges as telemetry from `kTransferStart` on, with the noise of the body's sensors.
std::vector<Pulse> noisy_pulses(const SpinningBody& body, const std::vector<Edge>& edges,
                                std::mt19937_64& rng);

/// Holds an orbit with Sun and Earth as seen from it.
struct Surroundings {
  Orbit orbit = transfer_orbit();
  SunEarthEphemeris around = seen_from(orbit);

  /// Returns the pulses of a body with the noise of its sensors; times count from `kTransferStart`.
  std::vector<Pulse> pulses(const SpinningBody& body, double from_s, double to_s,
                            std::mt19937_64& rng) const {
    return noisy_pulses(body, edges_between(body, around, from_s, to_s), rng);
  }
};

/// Returns the scenarios' transfer orbit with another right ascension of the ascending node.
Orbit transfer_with_node(double raan_deg);

/// Returns an orbit from `kTransferStart` on. With body_across_the_earth(), both beams scan across
/// the middle of the Earth: model errors then move the axis far, and without sun slit 1 both roots
/// fit all edges alike.
Orbit orbit_across_the_earth();
SpinningBody body_across_the_earth();

/// Returns a body for which chord, dihedral and sun angle are well observed: its axis is within
/// `tilt_rad` of perpendicular to the Earth direction, the Sun within 25 deg of its equator.
SpinningBody random_body(const SunEarthEphemeris& around, double tilt_rad, std::mt19937_64& rng);

/// Returns an accepted fix.
SpinFix made_fix(const Eigen::Vector3d& axis_icrf, const Eigen::Matrix2d& covariance_rad2);

/// Returns a fix with this sigma in each direction and an axis error drawn from it.
SpinFix drawn_fix(const Eigen::Vector3d& axis_icrf, double sigma_rad, std::mt19937_64& rng);

/// Returns the error of an estimated axis in its tangent plane, rad.
Eigen::Vector2d error_rad(const Eigen::Vector3d& estimated_icrf, const Eigen::Vector3d& true_icrf);

/// Returns the squared error of an estimate or a fix, normalised by its covariance: chi-square with
/// two degrees of freedom.
template <class Estimate>
double squared_error(const Estimate& estimate, const Eigen::Vector3d& true_icrf) {
  return normalised_square(error_rad(estimate.axis_icrf, true_icrf), estimate.covariance_rad2);
}

}  // namespace spindrift::testing
