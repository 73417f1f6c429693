#include "pipelines/reconstruction/observations.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/reconstruction/torque_free_arc.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/three_axis/gyro_screening.h"
#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

using enum SeparationEvent;

Unexpected refused(ErrorCode code, std::string message) {
  return Unexpected{{code, std::move(message)}};
}

/// Sorts the samples from T1 on and keeps the first of each instant, so that the result depends
/// neither on their order nor on additional samples.
template <class Sample>
std::vector<Sample> ordered(std::vector<Sample> samples, TaiTime separation) {
  std::erase_if(samples, [=](const Sample& sample) { return sample.t < separation; });
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.t < b.t; });
  const auto end = std::unique(samples.begin(), samples.end(),
                               [](const Sample& a, const Sample& b) { return a.t == b.t; });
  samples.erase(end, samples.end());
  return samples;
}

struct Samples {
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  double held_s;
};

std::optional<Error> outside(const std::vector<EventTime>& events, const Samples& samples) {
  const TaiTime first = later_by_s(samples.gyro.front().t, -samples.held_s);
  const TaiTime last = later_by_s(samples.gyro.back().t, samples.held_s);
  for (const EventTime& event : events) {
    if (event.event != Separation && (event.t < first || event.t > last)) {
      return Error{ErrorCode::InvalidInput,
                   fmt::format("{} is {}: the gyro samples allow {} to {}", name_of(event.event),
                               format_utc(event.t), format_utc(first), format_utc(last))};
    }
  }
  return std::nullopt;
}

bool is_within(const Observations& all, TaiTime t) {
  return t >= all.origin && all.seconds_of(t) <= all.end_s;
}

void add_stars(const StarTracker& tracker, const std::vector<StarFix>& fixes, TaiTime last,
               Observations& all) {
  for (const StarFix& fix : fixes) {
    if (fix.t >= all.origin && fix.t <= last) {
      const Eigen::Quaterniond q =
          fix.q_icrf_sensor.normalized() * tracker.q_body_sensor.normalized().conjugate();
      all.stars.push_back({.t_s = all.seconds_of(fix.t), .q_icrf_body = q});
      all.end_s = std::max(all.end_s, all.stars.back().t_s);
    }
  }
}

void add_sun(const std::vector<SunDirection>& vectors, const std::optional<Orbit>& orbit,
             Observations& all) {
  ApparentSun sun;
  for (const SunDirection& vector : vectors) {
    if (!is_within(all, vector.t)) {
      continue;
    }
    OrbitState spacecraft{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    const auto state = orbit ? std::optional{orbit->at(vector.t)} : std::nullopt;
    if (state && *state) {
      spacecraft = **state;
    } else if (state) {
      ++all.shadow_unknown;
    }
    const Eigen::Vector3d sun_icrf = sun.direction_icrf(vector.t, spacecraft);
    if (state && *state && is_in_shadow(spacecraft.position_icrf_km, sun_icrf)) {
      ++all.in_shadow;
      continue;
    }
    all.sun.push_back({.t_s = all.seconds_of(vector.t),
                       .measured_body = vector.sun_body.normalized(),
                       .sun_icrf = sun_icrf});
  }
}

std::vector<TimedRate> timed(std::span<const GyroSample> samples, TaiTime origin) {
  std::vector<TimedRate> rates;
  for (const GyroSample& sample : samples) {
    rates.push_back(
        {.t_s = seconds_between(origin, sample.t), .rate_body_rad_s = sample.rate_body_rad_s});
  }
  return rates;
}

/// Returns the gyro samples from T2 to shortly after the end.
std::vector<GyroSample> needed(const Samples& samples, const Observations& all) {
  std::vector<GyroSample> within;
  std::copy_if(samples.gyro.begin(), samples.gyro.end(), std::back_inserter(within),
               [&](const GyroSample& sample) {
                 return sample.t >= all.origin &&
                        all.seconds_of(sample.t) <= all.end_s + samples.held_s;
               });
  return within;
}

Expected<RateTrack> rates_of(const Samples& samples, const GyroSensor& sensor, Observations& all) {
  ScreenedGyro gyro = screened(needed(samples, all), sensor);
  all.gyro_left_out = std::move(gyro.left_out);
  if (gyro.usable.size() < 2) {
    return refused(ErrorCode::Unobservable,
                   fmt::format("{} gyro samples behind T2 can be used, {} are saturated, {} "
                               "frozen and {} off from their neighbours: at least 2 are needed",
                               gyro.usable.size(), all.gyro_left_out_by(Rejection::Saturated),
                               all.gyro_left_out_by(Rejection::Frozen),
                               all.gyro_left_out_by(Rejection::Outlier)));
  }
  all.first_is_outlier = gyro.first_is_outlier;
  all.gyro_noise = gyro.noise;
  const double louder = gyro.noise.value_or(1.0);
  all.gyro_noise_rad_s = sensor.noise_rad_s * (louder > kLouder ? louder : 1.0);
  all.gyro_samples = std::ssize(gyro.usable);
  return RateTrack{timed(gyro.usable, all.origin), 0.0, all.end_s, all.gyro_noise_rad_s};
}

Expected<Samples> samples_of(const ReconstructionRequest& request) {
  const TaiTime separation = request.times.separation;
  Samples samples{.gyro = ordered(request.gyro, separation),
                  .sun = request.sensors.sun_sensor ? ordered(request.sun_directions, separation)
                                                    : std::vector<SunDirection>{},
                  .stars = ordered(request.star_fixes, separation),
                  .held_s = 0.0};
  if (samples.gyro.size() < 2) {
    return refused(
        ErrorCode::Unobservable,
        fmt::format("{} gyro samples from T1 on: at least 2 are needed", samples.gyro.size()));
  }
  if (samples.stars.empty()) {
    return refused(
        ErrorCode::Unobservable,
        "no star fix from T1 on: nothing can be anchored; samples up to the first one are "
        "needed");
  }
  samples.held_s = held_s(samples.gyro);
  return samples;
}

/// Checks the turn from T1 to T2 that the rate at T2 implies.
std::optional<Error> turns_too_often(const Observations& all) {
  const double rate_rad_s = all.rates.rate_at(0.0).norm();
  const double arc_s = elapsed_s(all.events.front().t, all.origin);
  if (rate_rad_s * arc_s <= kLongestArc_rad) {
    return std::nullopt;
  }
  return Error{
      ErrorCode::InvalidInput,
      fmt::format("the rate of the first gyro sample behind T2, {}, is {:.4g} deg/s, and T1 "
                  "lies {:.0f} s before: a turn of more than {:.0f} rad cannot be followed "
                  "back; check the gyro's unit, or T1",
                  format_utc(all.origin), degrees(rate_rad_s), arc_s, kLongestArc_rad)};
}

}  // namespace

double held_s(std::span<const GyroSample> gyro) {
  return gyro.empty() ? 0.0 : 2.0 * usual_step_s(timed(gyro, gyro.front().t));
}

Observation sun_observation(const Observations& all, const SunObservation& sun,
                            const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = sun.measured_body.unitOrthogonal();
  across.row(1) = sun.measured_body.cross(across.row(0).transpose());
  Observation said{.t = shifted(all.origin, sun.t_s),
                   .source = SampleSource::Sun,
                   .residual = {.freedom = 2},
                   .nis = off.dot(covariance.llt().solve(off))};
  said.residual.value.head<2>() = across * off;
  said.residual.sigma.head<2>() = (across * covariance * across.transpose()).diagonal().cwiseSqrt();
  return said;
}

std::int64_t Observations::gyro_left_out_by(Rejection test) const {
  return std::count_if(gyro_left_out.begin(), gyro_left_out.end(),
                       [=](const RejectedSample& sample) { return sample.rejected_by == test; });
}

void add_gyro_left_out(const Observations& all, std::vector<Observation>& said) {
  std::transform(all.gyro_left_out.begin(), all.gyro_left_out.end(), std::back_inserter(said),
                 &observation_of);
}

SensorResiduals gyro_residuals(const Observations& all) {
  return {.count = all.gyro_samples,
          .outliers = std::ssize(all.gyro_left_out),
          .noise = all.gyro_noise};
}

Expected<Observations> observations_of(const ReconstructionRequest& request) {
  if (auto error = refusal_of(request)) {
    return Unexpected{*std::move(error)};
  }
  const auto samples = samples_of(request);
  if (!samples) {
    return Unexpected{samples.error()};
  }
  auto events = event_times(request.times,
                            {.gyro = samples->gyro, .sun = samples->sun, .stars = samples->stars});
  if (!events) {
    return Unexpected{events.error()};
  }
  if (auto error = outside(*events, *samples)) {
    return Unexpected{*std::move(error)};
  }
  const TaiTime origin = (*events)[1].t;
  Observations all{.origin = origin, .events = *std::move(events), .rates = {}};
  all.end_s = all.seconds_of(all.events.back().t);
  const TaiTime last = std::min(later_by_s(samples->gyro.back().t, samples->held_s),
                                later_by_s(all.events.back().t, kUsedBehindFirstFix_s));
  add_stars(*request.sensors.star_tracker, samples->stars, last, all);
  if (all.stars.empty()) {
    return Unexpected{nothing_anchored(origin)};
  }
  add_sun(samples->sun, orbit_of(request), all);
  auto rates = rates_of(*samples, *request.sensors.gyro, all);
  if (!rates) {
    return Unexpected{rates.error()};
  }
  all.rates = *std::move(rates);
  if (auto too_fast = turns_too_often(all)) {
    return Unexpected{*std::move(too_fast)};
  }
  return all;
}

}  // namespace spindrift
