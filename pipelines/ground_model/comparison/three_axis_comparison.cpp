#include "pipelines/ground_model/comparison/three_axis_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/ground_model/link/silence.h"
#include "pipelines/ground_model/sensors/three_axis_reading.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

Expected<void> check_noise(const ThreeAxisSensors& sensors) {
  const bool is_without = (sensors.gyro && !(sensors.gyro->noise_rad_s > 0.0)) ||
                          (sensors.star_tracker && !(sensors.star_tracker->noise_rad > 0.0)) ||
                          (sensors.sun_sensor && !(sensors.sun_sensor->noise_rad > 0.0)) ||
                          (sensors.magnetometer && !(sensors.magnetometer->noise_nt > 0.0));
  if (is_without) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       "a sensor of the model has no noise by which flight could be judged: each "
                       "true noise must be above 0"}};
  }
  return {};
}

const FlownBody& body_of(const FlownBody& body) { return body; }
const FlownBody& body_of(const FlownSeparation& separation) { return separation.body; }
const FlownBody& body_of(const FlownOrientation& orientation) { return orientation.body; }
const FlownBody& body_of(const FlownRescue& rescue) { return rescue.body; }

template <class Scenario>
Expected<ThreeAxisModel> model_of(const Scenario& scenario, const Orbit& orbit) {
  return check_noise(scenario.view.sensors)
      .and_then([&] { return flown(scenario, orbit); })
      .map([&](const auto& flight) {
        const FlownBody& body = body_of(flight);
        ThreeAxisSensors sensors = scenario.view.sensors;
        if (sensors.gyro) {
          sensors.gyro->bias_rad_s = body.bias_rad_s;
        }
        return ThreeAxisModel{.start = scenario.truth.body.start,
                              .motion = body.motion,
                              .sensors = std::move(sensors),
                              .gyro_gaps = scenario.view.faults.gyro_gaps,
                              .orbit = orbit};
      });
}

/// Returns the noise of a reading that is rounded to multiples of `step`.
double with_steps(double sigma, double step) { return std::hypot(sigma, step / std::sqrt(12.0)); }

std::vector<double> elements_of(const Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// Returns the turn between directions of any length, deg, along X and Y turned with -Z to `from`.
std::vector<double> turn_deg(const Vector3d& from, const Vector3d& to) {
  const auto q = shortest_turn(-Vector3d::UnitZ(), from);
  const Vector3d seen = q.conjugate() * to.normalized();
  const double across = std::hypot(seen.x(), seen.y());
  const double deg_per_one =
      across > 0.0 ? kDegPerRad * std::atan2(across, -seen.z()) / across : kDegPerRad;
  return {deg_per_one * seen.x(), deg_per_one * seen.y()};
}

}  // namespace

Expected<ThreeAxisModel> three_axis_model(const SeparationScenario& scenario, const Orbit& orbit) {
  return model_of(scenario, orbit);
}

Expected<ThreeAxisModel> three_axis_model(const TumblingScenario& scenario, const Orbit& orbit) {
  return model_of(scenario, orbit);
}

Expected<ThreeAxisModel> three_axis_model(const OrientationScenario& scenario, const Orbit& orbit) {
  return model_of(scenario, orbit);
}

Expected<ThreeAxisModel> three_axis_model(const RescueScenario& scenario, const Orbit& orbit) {
  return model_of(scenario, orbit);
}

ThreeAxisComparison::ThreeAxisComparison(const ThreeAxisModel& model) : model_{&model} {
  const ThreeAxisSensors& sensors = model.sensors;
  if (const auto& gyro = sensors.gyro) {
    add(SampleKind::Gyro, gyro->sampling,
        kDegPerRad * with_steps(gyro->noise_rad_s, gyro->resolution_rad_s), "deg/s", 3);
  }
  if (const auto& tracker = sensors.star_tracker) {
    add(SampleKind::Star, tracker->sampling, kDegPerRad * tracker->noise_rad, "deg", 3);
  }
  if (const auto& sensor = sensors.sun_sensor) {
    add(SampleKind::Sun, sensor->sampling,
        kDegPerRad * with_steps(sensor->noise_rad, sensor->resolution), "deg", 2);
  }
  if (const auto& magnetometer = sensors.magnetometer) {
    add(SampleKind::Magnetometer, magnetometer->sampling,
        with_steps(magnetometer->noise_nt, magnetometer->resolution_nt), "nT", 3);
  }
}

void ThreeAxisComparison::add(SampleKind kind, const Sampling& sampling, double sigma,
                              std::string_view unit, int values) {
  sensors_.push_back({.kind = kind,
                      .sampling = sampling,
                      .sigma = sigma,
                      .unit = unit,
                      .values = values,
                      .channel = channels_});
  channels_ += 1 + static_cast<std::size_t>(values);
}

std::vector<ComparedChannel> ThreeAxisComparison::channels() const {
  std::vector<ComparedChannel> channels;
  for (const Sensor& sensor : sensors_) {
    const double held_s = holding_s(sensor.sampling.step_s);
    channels.push_back(
        {.name = std::string{name_of(sensor.kind)}, .unit = "", .holding_s = held_s});
    for (int i = 0; i < sensor.values; ++i) {
      channels.push_back({.name = fmt::format("{}_{}", name_of(sensor.kind), "xyz"[i]),
                          .unit = sensor.unit,
                          .holding_s = held_s});
    }
  }
  return channels;
}

ThreeAxisComparison::Sensor* ThreeAxisComparison::find(SampleKind kind) {
  const auto found = std::find_if(sensors_.begin(), sensors_.end(),
                                  [kind](const Sensor& sensor) { return sensor.kind == kind; });
  return found == sensors_.end() ? nullptr : &*found;
}

/// Returns the time since the start; empty outside the span of the model.
std::optional<double> ThreeAxisComparison::time_s(TaiTime t) const {
  constexpr double kRounding_s = 1e-6;
  const double t_s = elapsed_s(model_->start, t);
  const bool is_within = t_s >= -kRounding_s && t_s <= model_->motion.end_s() + kRounding_s;
  return is_within ? std::optional{t_s} : std::nullopt;
}

std::vector<ComparedSample> ThreeAxisComparison::compare(const GyroSample& sample) {
  const auto t_s = time_s(sample.t);
  const auto& gyro = model_->sensors.gyro;
  if (!t_s || !gyro) {
    return {};
  }
  const Vector3d read_rad_s =
      gyro_reading(model_->motion.at(*t_s).rate_body_rad_s, gyro->bias_rad_s, gyro->range_rad_s);
  return compared(SampleKind::Gyro, sample.t, elements_of(kDegPerRad * sample.rate_body_rad_s),
                  elements_of(kDegPerRad * read_rad_s));
}

std::vector<ComparedSample> ThreeAxisComparison::compare(const StarFix& fix) {
  const auto t_s = time_s(fix.t);
  const auto& tracker = model_->sensors.star_tracker;
  if (!t_s || !tracker) {
    return {};
  }
  const Eigen::Quaterniond q_icrf_body = fix.q_icrf_sensor * tracker->q_body_sensor.conjugate();
  const Vector3d turn_rad =
      rotation_vector_of(model_->motion.at(*t_s).q_icrf_body.conjugate() * q_icrf_body);
  return compared(SampleKind::Star, fix.t, elements_of(kDegPerRad * turn_rad), {0.0, 0.0, 0.0});
}

std::vector<ComparedSample> ThreeAxisComparison::compare(const SunDirection& sun) {
  const auto t_s = time_s(sun.t);
  if (!t_s || !model_->sensors.sun_sensor) {
    return {};
  }
  const auto expected = sun_body(sun.t, *t_s);
  if (!expected) {
    return {};
  }
  const Eigen::Quaterniond q_body_sensor =
      quaternion_by(model_->sensors.sun_sensor->misalignment_rad);
  return compared(SampleKind::Sun, sun.t,
                  turn_deg(q_body_sensor.conjugate() * *expected, sun.sun_body), {0.0, 0.0});
}

std::vector<ComparedSample> ThreeAxisComparison::compare(const MagneticField& field) {
  const auto t_s = time_s(field.t);
  const auto& magnetometer = model_->sensors.magnetometer;
  if (!t_s || !magnetometer) {
    return {};
  }
  const auto field_nt = model_->orbit.at(field.t).and_then([&](const OrbitState& spacecraft) {
    return field_icrf_nt(magnetometer->field, field.t, spacecraft.position_icrf_km, earth_);
  });
  if (!field_nt) {
    return {};
  }
  const Vector3d read_nt =
      model_->motion.at(*t_s).q_icrf_body.conjugate() * *field_nt + magnetometer->bias_nt;
  return compared(SampleKind::Magnetometer, field.t, elements_of(field.field_body_nt),
                  elements_of(read_nt));
}

/// Compares a sample; the model must have the sensor, and its span must contain `t`.
std::vector<ComparedSample> ThreeAxisComparison::compared(SampleKind kind, TaiTime t,
                                                          const std::vector<double>& flight,
                                                          const std::vector<double>& model) {
  Sensor& sensor = *find(kind);
  const double t_s = *time_s(t);
  sensor.last_s = std::max(sensor.last_s.value_or(t_s), t_s);
  std::vector<ComparedSample> all = {{.channel = sensor.channel, .t = t, .came = true}};
  for (std::size_t i = 0; i < flight.size(); ++i) {
    all.push_back(
        {.channel = sensor.channel + 1 + i,
         .t = t,
         .came = true,
         .value = ComparedValue{.flight = flight[i], .model = model[i], .sigma = sensor.sigma}});
  }
  note_missing(t, t_s, all);
  return all;
}

/// Adds the sensors that should have sent by then, and did not.
void ThreeAxisComparison::note_missing(TaiTime t, double t_s, std::vector<ComparedSample>& all) {
  if (newest_s_ && t_s < *newest_s_) {
    return;
  }
  newest_s_ = t_s;
  for (Sensor& sensor : sensors_) {
    // A sensor that has not sent yet counts from the first sample of any sensor.
    const double last_s = sensor.last_s.value_or(t_s);
    if (t_s - last_s <= 1.5 * sensor.sampling.step_s) {
      sensor.last_s = last_s;
    } else if (sends(sensor, t_s)) {
      all.push_back({.channel = sensor.channel, .t = t, .came = false});
    } else {
      sensor.last_s = t_s;
    }
  }
}

bool ThreeAxisComparison::sends(const Sensor& sensor, double t_s) {
  if (t_s < sensor.sampling.from_s) {
    return false;
  }
  if (sensor.kind == SampleKind::Gyro) {
    return !is_silent(model_->gyro_gaps, t_s);
  }
  if (sensor.kind != SampleKind::Sun) {
    return true;
  }
  const TaiTime t = shifted(model_->start, t_s);
  const auto spacecraft = model_->orbit.at(t);
  const auto sun = sun_body(t, t_s);
  return spacecraft && sun && is_in_view(*model_->sensors.sun_sensor, *sun) &&
         !is_in_shadow(spacecraft->position_icrf_km, sun_.direction_icrf(t, *spacecraft));
}

/// Returns the model's unit vector to the Sun in body axes; empty where there is no orbit.
std::optional<Vector3d> ThreeAxisComparison::sun_body(TaiTime t, double t_s) {
  const auto spacecraft = model_->orbit.at(t);
  return spacecraft ? std::optional<Vector3d>{model_->motion.at(t_s).q_icrf_body.conjugate() *
                                              sun_.direction_icrf(t, *spacecraft)}
                    : std::nullopt;
}

}  // namespace spindrift
