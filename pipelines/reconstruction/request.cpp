#include "pipelines/reconstruction/request.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <iterator>
#include <string>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

Error configuration(std::string message) {
  return {ErrorCode::InvalidConfiguration, std::move(message)};
}

std::optional<Error> refusal_of(const Inertia& inertia) {
  const Eigen::Matrix3d& kg_m2 = inertia.kg_m2;
  if (!kg_m2.allFinite() || !kg_m2.isApprox(kg_m2.transpose(), 1e-9)) {
    return configuration("the inertia matrix must be symmetric and finite");
  }
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{kg_m2}.eigenvalues().minCoeff();
  if (!(least > 0.0)) {
    return configuration(fmt::format(
        "the inertia matrix has a principal moment of {} kg m2: all three must be above 0", least));
  }
  if (!(inertia.sigma_fraction >= 0.0) || !(inertia.sigma_fraction < 1.0)) {
    return configuration(fmt::format("sigma_fraction of the inertia is {}: must lie in [0, 1)",
                                     inertia.sigma_fraction));
  }
  return std::nullopt;
}

std::optional<Error> refusal_of(const ThreeAxisConfig& sensors) {
  if (!sensors.gyro) {
    return Error{ErrorCode::Unobservable,
                 "the mission names no gyro: nothing links the attitudes of different times"};
  }
  if (!sensors.star_tracker) {
    return Error{ErrorCode::Unobservable,
                 "the mission names no star tracker: nothing can be anchored"};
  }
  const auto check = [](const char* what, double value) -> std::optional<Error> {
    return is_positive(value) ? std::nullopt
                              : std::optional{configuration(fmt::format(
                                    "{} is {}: must be finite and above 0", what, value))};
  };
  auto found = check("the gyro's noise in rad/s", sensors.gyro->noise_rad_s);
  if (!found) {
    found = check("the gyro's bias sigma in rad/s", sensors.gyro->bias_sigma_rad_s);
  }
  if (!found) {
    found = check("the star tracker's noise in rad", sensors.star_tracker->noise_rad);
  }
  if (!found && sensors.sun_sensor) {
    found = check("the sun sensor's noise in rad", sensors.sun_sensor->noise_rad);
  }
  return !found && sensors.inertia ? refusal_of(*sensors.inertia) : found;
}

Error not_finite(const char* sensor, TaiTime t) {
  return {ErrorCode::InvalidInput,
          fmt::format("the {} sample of {} is not finite", sensor, format_utc(t))};
}

std::optional<Error> length_refused(const char* sensor, TaiTime t, double length) {
  if (std::abs(length - 1.0) <= kUnitTolerance) {
    return std::nullopt;
  }
  return Error{ErrorCode::InvalidInput,
               fmt::format("the {} of {} has the length {}: must be 1 within {}", sensor,
                           format_utc(t), length, kUnitTolerance)};
}

std::optional<Error> samples_refused(const ReconstructionRequest& request) {
  for (const GyroSample& sample : request.gyro) {
    if (!sample.rate_body_rad_s.allFinite()) {
      return not_finite("gyro", sample.t);
    }
  }
  for (const SunDirection& sample : request.sun_directions) {
    if (!sample.sun_body.allFinite()) {
      return not_finite("sun", sample.t);
    }
    if (auto found = length_refused("sun vector", sample.t, sample.sun_body.norm())) {
      return found;
    }
  }
  for (const StarFix& sample : request.star_fixes) {
    if (!sample.q_icrf_sensor.coeffs().allFinite()) {
      return not_finite("star", sample.t);
    }
    if (auto found =
            length_refused("quaternion of the star fix", sample.t, sample.q_icrf_sensor.norm())) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

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

std::optional<Error> refusal_of(const ReconstructionRequest& request) {
  if (auto found = refusal_of(request.sensors)) {
    return found;
  }
  if (!(request.disturbance_rad_s2 >= 0.0) || !std::isfinite(request.disturbance_rad_s2)) {
    return configuration(fmt::format("disturbance_rad_s2 is {}: must be finite and at least 0",
                                     request.disturbance_rad_s2));
  }
  return samples_refused(request);
}

}  // namespace spindrift
