#include "pipelines/supervision/channel_presence.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/side.h"
#include "pipelines/supervision/view_margin.h"

namespace spindrift {
namespace {

/// Returns the other slit, or the other end of the chord.
PulseChannel partner_of(PulseChannel channel) {
  return static_cast<PulseChannel>(index_of(channel) ^ 1U);
}

/// Slit 1 reaches to the spin axis; slit 2 ends at its cant angle from the axis.
bool slit_sees(PulseChannel channel, const SunSensor& sensor, double sun_angle_rad,
               double to_spare_rad) {
  const double end_rad = channel == PulseChannel::Sun2 ? sensor.slit_cant_rad : 0.0;
  return std::min(sun_angle_rad, std::numbers::pi - sun_angle_rad) > end_rad + to_spare_rad;
}

bool beam_crosses(const InfraredSensor& beam, double earth_angle_rad, double disc_rad,
                  double to_spare_rad) {
  const auto crosses = [&](double radius_rad) {
    return predict_chord_rad(beam.mount_angle_rad, earth_angle_rad, radius_rad).has_value();
  };
  return disc_rad > to_spare_rad && crosses(disc_rad - to_spare_rad) &&
         crosses(disc_rad + to_spare_rad);
}

}  // namespace

ChannelPresence::ChannelPresence(SpinConfig config, Orbit orbit, int silent_revolutions)
    : config_{std::move(config)},
      orbit_{std::move(orbit)},
      limit_{static_cast<double>(silent_revolutions)} {
  for (const std::string_view name : kPulseChannelNames) {
    channels_.push_back(
        {.watch = ConditionWatch{AlertCode::ChannelSilent, "revolutions", {}, std::string{name}}});
  }
}

ConditionChanges ChannelPresence::evaluate(const Pulse& edge, std::span<const AxisSeen> axes) {
  ConditionChanges changes;
  if (!newest_) {
    for (Channel& one : channels_) {
      one.since = edge.t;
    }
  }
  newest_ = edge.t;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    Channel& one = channels_[i];
    if (channel == edge.channel) {
      one.has_come = true;
      one.of_others = {};
      one.since = edge.t;
    } else {
      ++one.of_others.at(index_of(edge.channel));
    }
    if (channel == edge.channel || is_silent(channel, edge.t, axes)) {
      report(channel, edge.t, changes);
    }
  }
  return changes;
}

ConditionChanges ChannelPresence::settle(const AxisSeen& axis) {
  ConditionChanges changes;
  for (std::size_t i = 0; newest_ && i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    if (is_silent(channel, *newest_, {&axis, 1})) {
      report(channel, *newest_, changes);
    }
  }
  return changes;
}

void ChannelPresence::report(PulseChannel channel, TaiTime t, ConditionChanges& changes) {
  add(channels_[index_of(channel)].watch.update(t, {.value = missed(channel), .limit = limit_}),
      changes);
}

/// Restarts the count when a channel comes into view. Where slit 2 sees the Sun, slit 1 does,
/// whatever the axis. An axis that hides the other slit or the other end of the chord, which comes,
/// is not the true one.
bool ChannelPresence::is_silent(PulseChannel channel, TaiTime t, std::span<const AxisSeen> axes) {
  if (missed(channel) <= limit_) {
    return false;
  }
  Channel& one = channels_[index_of(channel)];
  const PulseChannel partner = partner_of(channel);
  const bool partner_comes =
      channels_[index_of(partner)].has_come && missed(partner) <= 0.5 * limit_;
  if (partner_comes && channel == PulseChannel::Sun1) {
    return true;
  }
  if (axes.empty()) {
    return false;
  }
  bool in_view = false;
  bool was_in_view = one.since.has_value();
  for (const AxisSeen& axis : axes) {
    if (partner_comes && !is_in_view(partner, t, axis)) {
      continue;
    }
    was_in_view = was_in_view && (one.has_come || is_in_view(channel, *one.since, axis));
    in_view = is_in_view(channel, t, axis);
    if (!in_view) {
      break;
    }
  }
  const bool is_silent = was_in_view && in_view;
  if (!is_silent) {
    one.has_come = false;
    one.of_others = {};
    one.since = in_view ? std::optional{t} : std::nullopt;
  }
  return is_silent;
}

double ChannelPresence::missed(PulseChannel channel) const {
  const auto& others = channels_[index_of(channel)].of_others;
  return *std::max_element(others.begin(), others.end());
}

bool ChannelPresence::is_in_view(PulseChannel channel, TaiTime t, const AxisSeen& axis) const {
  const auto state = orbit_.at(t);
  if (!state || (!sees_the_sun(channel) && !sensor_of(config_, side_of(channel)))) {
    return false;
  }
  const Eigen::Vector3d earth_icrf = -state->position_icrf_km.normalized();
  const auto disc_rad =
      earth_disc_half_angle_rad(state->position_icrf_km.norm(), config_.horizon.co2_altitude_km);
  if (!disc_rad) {
    return false;
  }
  const double to_spare_rad = view_margin_rad(axis.sigma_rad);
  if (sees_the_sun(channel)) {
    const Eigen::Vector3d sun_icrf = geometric_sun_icrf_km(t).normalized();
    return angle_between_rad(sun_icrf, earth_icrf) > *disc_rad + to_spare_rad &&
           slit_sees(channel, config_.sun_sensor, angle_between_rad(axis.axis_icrf, sun_icrf),
                     to_spare_rad);
  }
  return beam_crosses(*sensor_of(config_, side_of(channel)),
                      angle_between_rad(axis.axis_icrf, earth_icrf), *disc_rad, to_spare_rad);
}

}  // namespace spindrift
