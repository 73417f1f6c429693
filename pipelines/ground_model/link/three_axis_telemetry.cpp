#include "pipelines/ground_model/link/three_axis_telemetry.h"

#include <cmath>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/sensors/three_axis_reading.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

/// Sends what the sensors measure of one motion.
class Downlink {
 public:
  Downlink(const BodyMotion& motion, TaiTime start, const ThreeAxisFaults& faults, Chance& chance)
      : motion_{motion}, start_{start}, faults_{faults}, chance_{chance} {}

  void send_stars(const TrueStarTracker& tracker) {
    for (const double t_s : due_s(tracker.sampling)) {
      const Vector3d off_rad = chance_.normal_vector(tracker.noise_rad);
      if (arrives(t_s, true)) {
        telemetry_.stars.push_back(
            {shifted(start_, t_s),
             star_reading(motion_.at(t_s).q_icrf_body, tracker.q_body_sensor, off_rad)});
      }
    }
  }

  void send_gyro(const TrueGyro& gyro) {
    for (const double t_s : due_s(gyro.sampling)) {
      const Vector3d error_rad_s = gyro.bias_rad_s + chance_.normal_vector(gyro.noise_rad_s);
      if (arrives(t_s, !is_silent(faults_.gyro_gaps, t_s))) {
        telemetry_.gyro.push_back(
            {shifted(start_, t_s),
             rounded(gyro_reading(motion_.at(t_s).rate_body_rad_s, error_rad_s, gyro.range_rad_s),
                     gyro.resolution_rad_s)});
      }
    }
  }

  Expected<void> send_sun(const TrueSunSensor& sensor, const Orbit& orbit) {
    ApparentSun sun;
    for (const double t_s : due_s(sensor.sampling)) {
      const TaiTime t = shifted(start_, t_s);
      const auto spacecraft = orbit.at(t);
      if (!spacecraft) {
        return Unexpected{spacecraft.error()};
      }
      const Vector3d sun_icrf = sun.direction_icrf(t, *spacecraft);
      const Vector3d sun_body = motion_.at(t_s).q_icrf_body.conjugate() * sun_icrf;
      const auto [off_rad, is_outlier] = sun_error(sensor);
      if (arrives(t_s, !is_in_shadow(spacecraft->position_icrf_km, sun_icrf) &&
                           is_in_view(sensor, sun_body))) {
        const Vector3d sun_sensor = quaternion_by(sensor.misalignment_rad).conjugate() * sun_body;
        telemetry_.sun.push_back(
            {t, rounded(direction_reading(sun_sensor, off_rad), sensor.resolution).normalized()});
        if (is_outlier) {
          telemetry_.sun_outliers.push_back(t);
        }
      }
    }
    return {};
  }

  Expected<void> send_field(const TrueMagnetometer& magnetometer, const Orbit& orbit) {
    TurningEarth earth;
    for (const double t_s : due_s(magnetometer.sampling)) {
      const TaiTime t = shifted(start_, t_s);
      const auto true_icrf_nt = orbit.at(t).and_then([&](const OrbitState& spacecraft) {
        return field_icrf_nt(magnetometer.field, t, spacecraft.position_icrf_km, earth);
      });
      if (!true_icrf_nt) {
        return Unexpected{true_icrf_nt.error()};
      }
      const Vector3d error_nt = magnetometer.bias_nt + chance_.normal_vector(magnetometer.noise_nt);
      if (arrives(t_s, true)) {
        telemetry_.fields.push_back(
            {t, rounded(motion_.at(t_s).q_icrf_body.conjugate() * *true_icrf_nt + error_nt,
                        magnetometer.resolution_nt)});
      }
    }
    return {};
  }

  ThreeAxisTelemetry telemetry() && { return std::move(telemetry_); }

 private:
  std::vector<double> due_s(const Sampling& sampling) const {
    std::vector<double> times_s;
    for (double i = 0.0; sampling.from_s + i * sampling.step_s <= motion_.end_s() + 1e-6; ++i) {
      times_s.push_back(sampling.from_s + i * sampling.step_s);
    }
    return times_s;
  }

  bool arrives(double t_s, bool is_measured) {
    const bool is_lost = chance_.uniform() < faults_.lost || is_silent(faults_.silences, t_s);
    telemetry_.missing += is_measured && is_lost ? 1 : 0;
    return is_measured && !is_lost;
  }

  std::pair<Eigen::Vector2d, bool> sun_error(const TrueSunSensor& sensor) {
    const double first_rad = sensor.noise_rad * chance_.normal();
    const double second_rad = sensor.noise_rad * chance_.normal();
    const bool is_outlier = chance_.uniform() < faults_.sun_outlier;
    const double way_rad = kTurn_rad * chance_.uniform();
    if (is_outlier) {
      return {faults_.sun_outlier_rad * Eigen::Vector2d{std::cos(way_rad), std::sin(way_rad)},
              true};
    }
    return {{first_rad, second_rad}, false};
  }

  const BodyMotion& motion_;
  TaiTime start_;
  const ThreeAxisFaults& faults_;
  Chance& chance_;
  ThreeAxisTelemetry telemetry_;
};

}  // namespace

bool is_in_view(const TrueSunSensor& sensor, const Vector3d& sun_body) {
  return angle_between_rad(-Vector3d::UnitZ(), sun_body) <= sensor.half_cone_rad;
}

Expected<ThreeAxisTelemetry> three_axis_telemetry(const BodyMotion& motion, TaiTime start,
                                                  const ThreeAxisSensors& sensors,
                                                  const ThreeAxisFaults& faults, const Orbit& orbit,
                                                  Chance& chance) {
  Downlink downlink{motion, start, faults, chance};
  if (sensors.star_tracker) {
    downlink.send_stars(*sensors.star_tracker);
  }
  if (sensors.gyro) {
    downlink.send_gyro(*sensors.gyro);
  }
  const auto done =
      sensors.sun_sensor ? downlink.send_sun(*sensors.sun_sensor, orbit) : Expected<void>{};
  return done
      .and_then([&] {
        return sensors.magnetometer ? downlink.send_field(*sensors.magnetometer, orbit)
                                    : Expected<void>{};
      })
      .map([&] { return std::move(downlink).telemetry(); });
}

}  // namespace spindrift
