/// @file
/// A pass cut into revolutions, each with the sky about it: what the sequential filter is fed.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/association/association.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sky.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

struct ObservedRevolution {
  Revolution revolution;
  Sky sky;
};

/// Revolutions as the associator finds them.
std::vector<ObservedRevolution> observed(const SpinConfig& config, const Orbit& orbit,
                                         std::vector<Pulse> pulses);

Sky sky_at(const Orbit& orbit, TaiTime t);

/// A transfer orbit from `kTransferStart` on, two and a half Earth radii up and climbing.
inline const TaiTime kTransferStart = tai_from_ns(1'795'143'637'000'000'000);
Orbit transfer_orbit();

/// Sun and Earth as seen from the orbit, time counted from `kTransferStart`; the ellipsoid stands
/// on the Earth's pole of date, all turned with it.
SunEarthEphemeris seen_from(const Orbit& orbit, const Eigen::Vector3d& horizon_km);

/// The scenarios' transfer orbit with another node.
Orbit transfer_with_node(double raan_deg);

/// Both beams look across the same middle of the Earth: errors of the model move the axis far, and
/// without sun slit 1 the two roots keep fitting all edges alike. From `kTransferStart` on.
Orbit orbit_across_the_earth();
SpinningBody body_across_the_earth();

/// Chord, dihedral and sun angle well observed: an axis across the Earth's direction within
/// `tilt_rad`, the Sun within 25 deg of the body's equator.
SpinningBody random_body(const SunEarthEphemeris& around, double tilt_rad, std::mt19937_64& rng);

/// What a fix of that sigma (each way) would say: the axis with an error drawn from it.
SpinFix drawn_fix(const Eigen::Vector3d& axis_icrf, double sigma_rad, std::mt19937_64& rng);

/// The error of an estimate in its tangent plane, rad.
Eigen::Vector2d error_rad(const Eigen::Vector3d& estimated_icrf, const Eigen::Vector3d& true_icrf);

}  // namespace spindrift::testing
