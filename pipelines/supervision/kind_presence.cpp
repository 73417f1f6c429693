#include "pipelines/supervision/kind_presence.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// All kinds are passed to TimeJump as one, so that a single continuing kind may move the time.
constexpr std::size_t kAnyKind = 0;

}  // namespace

KindPresence::KindPresence(const std::vector<SampleKind>& kinds, const ThreeAxisConfig& config,
                           std::optional<Orbit> orbit, double silent_s)
    : orbit_{std::move(orbit)}, silent_s_{silent_s} {
  for (const SampleKind kind : kinds) {
    channels_.push_back(
        {.kind = kind,
         .watch = ConditionWatch{AlertCode::ChannelSilent, "s", {}, std::string{name_of(kind)}},
         .is_expected = (kind == SampleKind::Gyro && config.gyro) ||
                        (kind == SampleKind::Magnetometer && config.magnetometer)});
  }
}

ConditionChanges KindPresence::evaluate(SampleKind kind, TaiTime t) {
  // The time of one sample alone may come from a wrong clock that no other sample supports.
  const TaiTime reached = std::min(t, before_);
  before_ = t;
  if (newest_ > TaiTime::min() && span_between(newest_, t) > TimeJump::kFar) {
    jump_.add_ahead(t, kAnyKind);
    if (!jump_.has_shown()) {
      return {};
    }
    newest_ = t;
  } else {
    jump_.hear(kAnyKind);
    newest_ = std::max(newest_, reached);
  }
  ConditionChanges changes;
  for (Channel& channel : channels_) {
    if (channel.last) {
      channel.last = std::min(*channel.last, newest_);
    } else if (channel.is_expected && newest_ > TaiTime::min()) {
      channel.last = newest_;
    }
    if (channel.kind == kind) {
      channel.last = std::max(channel.last.value_or(t), t);
    }
    // Checked at half the limit, which leaves the other half for the Sun to reappear.
    if (channel.last && elapsed_s(*channel.last, newest_) >= 0.5 * silent_s_ &&
        is_hidden(channel.kind, newest_)) {
      channel.last = newest_;
    } else if (channel.last && newest_ > TaiTime::min()) {
      const double silent_s = std::max(elapsed_s(*channel.last, newest_), 0.0);
      add(channel.watch.update(newest_, {.value = silent_s, .limit = silent_s_}), changes);
    }
  }
  return changes;
}

bool KindPresence::is_hidden(SampleKind kind, TaiTime t) {
  if (kind != SampleKind::Sun || !orbit_) {
    return false;
  }
  const auto spacecraft = orbit_->at(t);
  return spacecraft &&
         is_in_shadow(spacecraft->position_icrf_km, sun_.direction_icrf(t, *spacecraft));
}

}  // namespace spindrift
