#include "pipelines/ground_model/flights/channel_margins.h"

#include <fmt/format.h>

#include <cstddef>

#include "pipelines/frames/angle.h"

namespace spindrift {

Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationTruth& truth) {
  const OrientationControl& control = truth.control;
  const PdGains gains = control.gains();
  std::array<ChannelMargins, 3> channels;
  for (int i = 0; i < 3; ++i) {
    ChannelMargins& channel = channels.at(static_cast<std::size_t>(i));
    channel.designed = {.moment_kg_m2 = control.moments_kg_m2[i],
                        .kp_nm = gains.kp_nm[i],
                        .kd_nms = gains.kd_nms[i]};
    channel.flown = channel.designed;
    channel.flown.moment_kg_m2 = truth.body.inertia_kg_m2(i, i);
    channel.flown.sampling =
        LoopSampling{.period_s = control.period_s, .periods_late = control.periods_late};
    const auto designed = loop_margins(channel.designed);
    const auto flown = loop_margins(channel.flown);
    if (!designed || !flown) {
      return Unexpected{designed ? flown.error() : designed.error()};
    }
    channel.designed_margins = *designed;
    channel.flown_margins = *flown;
  }
  return channels;
}

Expected<void> check_margins(const OrientationTruth& truth) {
  const auto channels = channel_margins(truth);
  if (!channels) {
    return Unexpected{channels.error()};
  }
  for (const ChannelMargins& channel : *channels) {
    if (const LoopMargins& margins = channel.flown_margins; !(margins.phase_rad > 0.0)) {
      return Unexpected{
          {ErrorCode::InvalidConfiguration,
           fmt::format("a loop of {:.4g} rad/s that is closed every {} s, {} periods late, swings: "
                       "its phase margin of {:.3g} deg must be above 0",
                       margins.crossover_rad_s, truth.control.period_s, truth.control.periods_late,
                       degrees(margins.phase_rad))}};
    }
  }
  return {};
}

}  // namespace spindrift
