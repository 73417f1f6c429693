/// @file
/// The table of faults of a three-axis spacecraft with gyro, star tracker, Sun sensor and
/// magnetometer.

#pragma once

#include "pipelines/frames/angle.h"
#include "tests/property/alerts/fault.h"

namespace spindrift::testing {

/// Returns deploy/scenarios/tumbling.toml with all sensors from the start and without faults.
inline std::string tumbling_text() {
  std::string text = text_of(scenarios() / "tumbling.toml");
  text = text.substr(0, text.find("[truth.sun_sensor]"));
  text = replaced(text, "duration_s = 1800.0", "duration_s = 600.0");
  text = replaced(text, "range_deg_s = 3.0\n", "");
  return replaced(text, "first_star_fix_s = 1200.0", "first_star_fix_s = 0.0");
}

inline std::function<Eigen::Vector3d()> noise(double sigma) {
  return [rng = std::mt19937_64{2304},
          normal = std::normal_distribution<double>{0.0, sigma}]() mutable {
    return Eigen::Vector3d{normal(rng), normal(rng), normal(rng)};
  };
}

inline Eigen::Quaterniond turn(double deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond{Eigen::AngleAxisd{deg * kRadPerDeg, axis.normalized()}};
}

/// @name Faults of a vector that a sensor measures
/// @{
using VectorChange = std::function<void(Eigen::Vector3d&)>;

inline Spoil of_gyro(VectorChange change) {
  return changed<GyroSample>(
      [change](GyroSample& gyro, double /*t_s*/) mutable { change(gyro.rate_body_rad_s); });
}
inline Spoil of_sun(VectorChange change) {
  return changed<SunDirection>([change](SunDirection& sun, double /*t_s*/) mutable {
    change(sun.sun_body);
    sun.sun_body.normalize();
  });
}
inline Spoil of_field(VectorChange change) {
  return changed<MagneticField>(
      [change](MagneticField& field, double /*t_s*/) mutable { change(field.field_body_nt); });
}

inline VectorChange turned(double deg) {
  return [q = turn(deg, {1.0, 2.0, -1.0})](Eigen::Vector3d& v) { v = q * v; };
}
inline VectorChange shifted_by(const Eigen::Vector3d& off) {
  return [off](Eigen::Vector3d& v) { v += off; };
}
inline VectorChange noisy(double sigma) {
  return [draw = noise(sigma)](Eigen::Vector3d& v) { v += draw(); };
}
inline VectorChange times(const Eigen::Vector3d& factors) {
  return [factors](Eigen::Vector3d& v) { v = v.cwiseProduct(factors); };
}
/// @}

inline Spoil of_star(std::function<void(Eigen::Quaterniond&)> change) {
  return changed<StarFix>(
      [change](StarFix& fix, double /*t_s*/) mutable { change(fix.q_icrf_sensor); });
}

/// Simulates a tumble at 12 deg/s that the gyro does not measure.
inline void tumble(std::vector<Sent>& sent, const Window& window) {
  of_gyro([](Eigen::Vector3d& rate) { rate.x() = 10.0 * kRadPerDeg; })(sent, window);
  changed<StarFix>([](StarFix& fix, double t_s) {
    fix.q_icrf_sensor = fix.q_icrf_sensor * turn(12.0 * t_s, Eigen::Vector3d::UnitX());
  })(sent, window);
  changed<SunDirection>([](SunDirection& sun, double t_s) {
    sun.sun_body = turn(-12.0 * t_s, Eigen::Vector3d::UnitY()) * sun.sun_body;
  })(sent, window);
}

/// Returns the scenario of a spacecraft without these sensors.
inline std::string without(const std::vector<std::string>& sensors, std::string text) {
  for (const std::string& sensor : sensors) {
    const auto from = text.find("[three_axis." + sensor + "]");
    text.erase(from, text.find("\n[", from) + 1 - from);
  }
  return text;
}

/// Returns faults that are there from the first sample on, or of a spacecraft with few sensors.
inline std::vector<Fault> early_three_axis_faults() {
  const std::string lostsat = tumbling_text();
  const std::string starless = without({"star_tracker"}, lostsat);
  const std::string of_stars = without({"sun_sensor", "magnetometer"}, lostsat);
  const std::string fieldless = without({"magnetometer"}, lostsat);
  const auto either = [](const std::string& culprit) {
    return std::set<std::string>{"sensor.contradicts:" + culprit, "sensor.contradicts:unknown"};
  };
  const auto from_the_start = [](std::string name, std::set<std::string> keys, std::string scenario,
                                 Spoil sensors, double within_s) {
    return Fault{.name = std::move(name) + " from the start",
                 .keys = std::move(keys),
                 .scenario = std::move(scenario),
                 .sensors = std::move(sensors),
                 .within_s = within_s,
                 .window = kWholePass,
                 .ends = false};
  };
  return {
      from_the_start("gyro dead", silent("gyro"), lostsat, dead(is_of<GyroSample>), 6.0),
      from_the_start("magnetometer dead", silent("magnetometer"), lostsat,
                     dead(is_of<MagneticField>), 6.0),
      from_the_start("star tracker dead, no magnetometer", {"attitude.no_answer"}, fieldless,
                     dead(is_of<StarFix>), 305.0),
      from_the_start("Sun sensor turned by 90 deg, no star tracker", either("sun"), starless,
                     of_sun(turned(90.0)), 15.0),
      from_the_start("Sun sensor turned by 20 deg, no star tracker", either("sun"), starless,
                     of_sun(turned(20.0)), 15.0),
      from_the_start("field twice as strong, no star tracker", either("magnetometer"), starless,
                     of_field(times({2.0, 2.0, 2.0})), 15.0),
      from_the_start("star tracker turned by 5 deg, no magnetometer", contradicts("star"),
                     fieldless, of_star([](Eigen::Quaterniond& q) {
                       q = q * turn(5.0, {1.0, 2.0, -1.0});
                     }),
                     10.0),
      from_the_start("star tracker late by 0.2 s", {"attitude.doubtful", "sensor.contradicts:star"},
                     lostsat, moved(is_of<StarFix>, 0.2), 60.0),
      from_the_start("gyro x 10 % too large, no star tracker", contradicts("gyro"), starless,
                     of_gyro(times({1.1, 1.0, 1.0})), 120.0),
      {"star tracker turned by 40 deg, with a gyro alone", either("star"), of_stars,
       of_star([](Eigen::Quaterniond& q) {
         q = q * turn(40.0, {1.0, 2.0, -1.0});
       }),
       15.0},
  };
}

inline std::vector<Fault> three_axis_faults() {
  const auto stuck_alert = [](const std::string& sensor) {
    return std::set<std::string>{"sensor.stuck:" + sensor};
  };
  const std::string lostsat = tumbling_text();
  const std::string leosat = three_axis_text();
  const std::set<std::string> lost_or_diverged{"attitude.lost", "attitude.diverged"};
  const auto gyro_off_by = [](double deg_s) {
    return of_gyro(shifted_by({deg_s * kRadPerDeg, 0.0, 0.0}));
  };
  const auto star_and_sun_dead = [](std::vector<Sent>& sent, const Window& window) {
    dead(is_of<StarFix>)(sent, window);
    dead(is_of<SunDirection>)(sent, window);
  };
  const auto of_another_orbit = [lostsat](Mission& mission) {
    mission.orbit =
        loaded(replaced(lostsat, "mean_anomaly_deg = 0.0", "mean_anomaly_deg = 36.0")).orbit;
  };
  return {
      {"gyro dead", silent("gyro"), lostsat, dead(is_of<GyroSample>)},
      {"gyro stuck", stuck_alert("gyro"), lostsat, stuck<GyroSample>()},
      {"gyro turned by 20 deg", contradicts("gyro"), lostsat, of_gyro(turned(20.0))},
      {"gyro biased by 0.5 deg/s", contradicts("gyro"), lostsat, gyro_off_by(0.5)},
      {"gyro noisy, 1 deg/s", contradicts("gyro"), lostsat, of_gyro(noisy(1.0 * kRadPerDeg)), 30.0},
      {"gyro y of the wrong sign", contradicts("gyro"), lostsat, of_gyro(times({1.0, -1.0, 1.0}))},
      {"gyro in deg/s", contradicts("gyro"), lostsat, of_gyro(times({57.3, 57.3, 57.3}))},
      {"gyro late by a second",
       {"sensor.contradicts:gyro", "sensor.contradicts:unknown"},
       lostsat,
       late_by_a_second(is_of<GyroSample>),
       60.0},
      {"star tracker dead", silent("star"), lostsat, dead(is_of<StarFix>)},
      {"star tracker stuck", stuck_alert("star"), lostsat, stuck<StarFix>()},
      {"star tracker turned by 5 deg", contradicts("star"), lostsat,
       of_star([](Eigen::Quaterniond& q) {
         q = turn(5.0, {1.0, 2.0, -1.0}) * q;
       }),
       60.0},
      {"star tracker biased by 2 deg", contradicts("star"), lostsat,
       of_star([](Eigen::Quaterniond& q) {
         q = q * turn(2.0, {0.0, 1.0, 1.0});
       }),
       60.0},
      {"star tracker noisy, 5 deg", contradicts("star"), lostsat,
       of_star([draw = noise(5.0)](Eigen::Quaterniond& q) mutable {
         const Eigen::Vector3d by_deg = draw();
         q = q * turn(by_deg.norm(), by_deg);
       })},
      {"star tracker gives the inverse", contradicts("star"), lostsat,
       of_star([](Eigen::Quaterniond& q) { q = q.conjugate(); })},
      {"star tracker sends w first", contradicts("star"), lostsat,
       of_star([](Eigen::Quaterniond& q) {
         q = Eigen::Quaterniond{q.z(), q.w(), q.x(), q.y()};
       })},
      {"star tracker late by a second", contradicts("star"), lostsat,
       late_by_a_second(is_of<StarFix>), 60.0},
      {"Sun sensor dead", silent("sun"), lostsat, dead(is_of<SunDirection>)},
      {"Sun sensor stuck", stuck_alert("sun"), lostsat, stuck<SunDirection>()},
      {"Sun sensor turned by 10 deg", contradicts("sun"), lostsat, of_sun(turned(10.0)), 60.0},
      {"Sun sensor biased by 0.1", contradicts("sun"), lostsat, of_sun(shifted_by({0.1, 0.0, 0.1})),
       60.0},
      {"Sun sensor noisy, 10 deg", contradicts("sun"), lostsat, of_sun(noisy(0.17))},
      {"Sun sensor of the wrong sign", contradicts("sun"), lostsat,
       of_sun(times({-1.0, -1.0, -1.0}))},
      {"Sun sensor mirrors y", contradicts("sun"), lostsat, of_sun(times({1.0, -1.0, 1.0}))},
      {"Sun sensor late by a second", contradicts("sun"), lostsat,
       late_by_a_second(is_of<SunDirection>), 60.0},
      {"magnetometer dead", silent("magnetometer"), lostsat, dead(is_of<MagneticField>)},
      {"magnetometer stuck", stuck_alert("magnetometer"), lostsat, stuck<MagneticField>()},
      {"magnetometer turned by 10 deg", contradicts("magnetometer"), lostsat,
       of_field(turned(10.0)), 60.0},
      {"magnetometer biased by 5000 nT", contradicts("magnetometer"), lostsat,
       of_field(shifted_by({5e3, 0.0, 0.0}))},
      {"magnetometer noisy, 5000 nT", contradicts("magnetometer"), lostsat, of_field(noisy(5e3)),
       60.0},
      {"magnetometer z of the wrong sign", contradicts("magnetometer"), lostsat,
       of_field(times({1.0, 1.0, -1.0}))},
      {"magnetometer in gauss", contradicts("magnetometer"), lostsat,
       of_field(times({1e-5, 1e-5, 1e-5}))},
      // Below 5 sigma nothing is named, and the filter's errors of the pass remember it to its end.
      {"magnetometer late by a second",
       {"sensor.contradicts:magnetometer", "attitude.doubtful"},
       lostsat,
       late_by_a_second(is_of<MagneticField>),
       60.0,
       {},
       false},
      {"orbit wrong by ten minutes",
       contradicts("orbit"),
       lostsat,
       {},
       60.0,
       kWholePass,
       false,
       {},
       {},
       {},
       false,
       of_another_orbit},
      {"gyro bias jumps by 0.05 deg/s", lost_or_diverged, leosat, gyro_off_by(0.05), 60.0},
      {"gyro bias jumps by 0.005 deg/s",
       lost_or_diverged,
       leosat,
       gyro_off_by(0.005),
       120.0,
       {},
       false,
       {},
       {},
       {},
       false,
       {},
       "sensor.contradicts:gyro"},
      {"tumbling beyond the gyro's range",
       {"attitude.lost"},
       replaced(leosat, "noise_deg_s = 0.002", "noise_deg_s = 0.002\nrange_deg_s = 10.0"),
       tumble},
      {"gyro dead, no attitude held", {"attitude.doubtful"}, leosat, dead(is_of<GyroSample>), 45.0},
      {"star tracker and Sun sensor dead from the start",
       {"attitude.no_answer"},
       lostsat,
       star_and_sun_dead,
       70.0,
       kWholePass,
       false}};
}

}  // namespace spindrift::testing
