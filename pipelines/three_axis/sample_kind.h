/// @file
/// Maps each sample type to its SampleKind.

#pragma once

#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

constexpr SampleKind kind_of(const TimedOrbitState& /*state*/) { return SampleKind::OrbitState; }
constexpr SampleKind kind_of(const GyroSample& /*sample*/) { return SampleKind::Gyro; }
constexpr SampleKind kind_of(const StarFix& /*fix*/) { return SampleKind::Star; }
constexpr SampleKind kind_of(const SunDirection& /*sun*/) { return SampleKind::Sun; }
constexpr SampleKind kind_of(const MagneticField& /*field*/) { return SampleKind::Magnetometer; }

}  // namespace spindrift
