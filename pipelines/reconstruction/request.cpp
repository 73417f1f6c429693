#include "pipelines/reconstruction/request.h"

#include <iterator>

#include "pipelines/ephemeris/kepler_orbit.h"

namespace spindrift {

std::optional<Orbit> orbit_of(const ReconstructionRequest& request) {
  if (request.orbit) {
    return request.orbit;
  }
  std::optional<Orbit> orbit;
  TaiTime first = TaiTime::max();
  for (const TimedOrbitState& one : request.orbit_states) {
    const auto through = KeplerOrbit::through(one.t, one.state);
    if (through && one.t >= request.times.separation && one.t < first) {
      first = one.t;
      orbit = Orbit{*through};
    }
  }
  return orbit;
}

std::int64_t sample_count(const ReconstructionRequest& request) {
  return std::ssize(request.gyro) + std::ssize(request.sun_directions) +
         std::ssize(request.star_fixes);
}

}  // namespace spindrift
