/// @file
/// Position and velocity of the spacecraft relative to the Earth's centre.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/rounding.h"
#include "pipelines/core/sender.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct OrbitState {
  Eigen::Vector3d position_icrf_km;
  Eigen::Vector3d velocity_icrf_km_s;
};

/// State that a spacecraft reports itself.
struct TimedOrbitState {
  TaiTime t;
  OrbitState state{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Sender sender = Sender::First;
};

/// Returns whether two reported states are equal but for rounding.
inline bool say_the_same(const TimedOrbitState& a, const TimedOrbitState& b) {
  return same_but_for_rounding(a.state.position_icrf_km, b.state.position_icrf_km) &&
         same_but_for_rounding(a.state.velocity_icrf_km_s, b.state.velocity_icrf_km_s);
}

}  // namespace spindrift
