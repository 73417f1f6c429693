#include "pipelines/supervision/view_presence.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/wgs84.h"
#include "pipelines/supervision/view_margin.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
ViewPresence::ViewPresence(const ThreeAxisConfig& config, std::optional<Orbit> orbit,
                           double silent_s)
    : orbit_{std::move(orbit)}, silent_s_{silent_s} {
  const auto add = [this](SampleKind kind, const auto& sensor) {
    if (sensor && sensor->view) {
      sensors_.push_back(
          {.kind = kind,
           .view = *sensor->view,
           .watch = ConditionWatch{AlertCode::ChannelSilent, "s", {}, std::string{name_of(kind)}}});
    }
  };
  add(SampleKind::Sun, config.sun_sensor);
  add(SampleKind::Star, config.star_tracker);
}

std::vector<SampleKind> ViewPresence::others() const {
  std::vector<SampleKind> kinds{SampleKind::Gyro, SampleKind::Star, SampleKind::Sun,
                                SampleKind::Magnetometer};
  for (const Sensor& sensor : sensors_) {
    std::erase(kinds, sensor.kind);
  }
  return kinds;
}

void ViewPresence::see_sample(SampleKind kind, TaiTime t) {
  for (Sensor& sensor : sensors_) {
    if (sensor.kind == kind) {
      sensor.last = std::max(sensor.last.value_or(t), t);
    }
  }
}

ConditionChanges ViewPresence::see_answer(const AttitudeEstimate& estimate) {
  ConditionChanges changes;
  for (Sensor& sensor : sensors_) {
    if (estimate.assessment.quality == Quality::Lost) {
      continue;
    }
    if (!sensor.last || is_blind(sensor, estimate)) {
      sensor.last = std::max(sensor.last.value_or(estimate.t), estimate.t);
    }
    const double silent_s = std::max(elapsed_s(*sensor.last, estimate.t), 0.0);
    spindrift::add(sensor.watch.update(estimate.t, {.value = silent_s, .limit = silent_s_}),
                   changes);
  }
  return changes;
}

bool ViewPresence::is_blind(const Sensor& sensor, const AttitudeEstimate& estimate) const {
  const auto& [boresight_body, half_angle_rad] = sensor.view;
  const Eigen::Vector3d boresight_icrf = estimate.q_icrf_body * boresight_body;
  const double to_spare_rad = view_margin_rad(estimate.sigma_rad());
  const Eigen::Vector3d sun_icrf = geometric_sun_icrf_km(estimate.t).normalized();
  const double sun_rad = angle_between_rad(boresight_icrf, sun_icrf);
  const auto state = orbit_ ? std::optional{orbit_->at(estimate.t)} : std::nullopt;
  const bool has_place = state && *state;
  if (sensor.kind == SampleKind::Sun) {
    return sun_rad > half_angle_rad - to_spare_rad ||
           (has_place && is_in_shadow((*state)->position_icrf_km, sun_icrf));
  }
  if (sun_rad < half_angle_rad + to_spare_rad || !has_place) {
    return sun_rad < half_angle_rad + to_spare_rad;
  }
  const Eigen::Vector3d& position_km = (*state)->position_icrf_km;
  const double disc_rad =
      std::asin(std::min(wgs84::kEquatorialRadius_km / position_km.norm(), 1.0));
  return angle_between_rad(boresight_icrf, -position_km) < half_angle_rad + disc_rad + to_spare_rad;
}

}  // namespace spindrift
