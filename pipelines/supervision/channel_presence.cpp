#include "pipelines/supervision/channel_presence.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"

namespace spindrift {
namespace {

constexpr double kToSpare_rad = 1.0 * kRadPerDeg;
constexpr double kSigmasToSpare = 3.0;

}  // namespace

ChannelPresence::ChannelPresence(const SpinConfig& config, Orbit orbit, int silent_revolutions)
    : config_{config}, orbit_{std::move(orbit)}, limit_{static_cast<double>(silent_revolutions)} {
  for (const std::string_view name : kPulseChannelNames) {
    channels_.push_back(
        {.watch = ConditionWatch{AlertCode::ChannelSilent, "revolutions", {}, std::string{name}}});
  }
}

ConditionChanges ChannelPresence::see(const Pulse& edge, const std::optional<AxisSeen>& axis) {
  ConditionChanges changes;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    Channel& one = channels_[i];
    if (channel == edge.channel) {
      ++one.edges;
      one.of_others = {};
    } else {
      ++one.of_others.at(index_of(edge.channel));
    }
    const double missed_now = missed(channel);
    const bool is_back = missed_now == 0.0 && channel == edge.channel;
    const bool is_missed =
        one.edges > limit_ && missed_now > limit_ && axis && should_see(channel, edge.t, *axis);
    if (is_back || is_missed) {
      if (auto change = one.watch.see(edge.t, {.value = missed_now, .limit = limit_})) {
        changes.push_back(std::move(*change));
      }
    }
  }
  return changes;
}

double ChannelPresence::missed(PulseChannel channel) const {
  const auto& others = channels_[index_of(channel)].of_others;
  return *std::max_element(others.begin(), others.end());
}

bool ChannelPresence::should_see(PulseChannel channel, TaiTime t, const AxisSeen& axis) const {
  const auto state = orbit_.at(t);
  const bool is_north = channel == PulseChannel::NorthIn || channel == PulseChannel::NorthOut;
  const auto& beam = is_north ? config_.north : config_.south;
  if (!state || (!sees_the_sun(channel) && !beam)) {
    return false;
  }
  const Eigen::Vector3d earth_icrf = -state->position_icrf_km.normalized();
  const auto disc_rad =
      earth_disc_half_angle_rad(state->position_icrf_km.norm(), config_.horizon.co2_altitude_km);
  if (!disc_rad) {
    return false;
  }
  const double to_spare_rad = kToSpare_rad + kSigmasToSpare * axis.sigma_rad;
  if (sees_the_sun(channel)) {
    return angle_between_rad(geometric_sun_icrf_km(t).normalized(), earth_icrf) >
           *disc_rad + to_spare_rad;
  }
  const double earth_angle_rad = angle_between_rad(axis.axis_icrf, earth_icrf);
  const auto crosses = [&](double radius_rad) {
    return predict_chord_rad(beam->mount_angle_rad, earth_angle_rad, radius_rad).has_value();
  };
  return *disc_rad > to_spare_rad && crosses(*disc_rad - to_spare_rad) &&
         crosses(*disc_rad + to_spare_rad);
}

}  // namespace spindrift
