#include "pipelines/spin/types/pulse.h"

#include <algorithm>

namespace spindrift {

std::optional<PulseChannel> pulse_channel_from(std::string_view name) {
  const auto* const found = std::find(kPulseChannelNames.begin(), kPulseChannelNames.end(), name);
  if (found == kPulseChannelNames.end()) {
    return std::nullopt;
  }
  return static_cast<PulseChannel>(found - kPulseChannelNames.begin());
}

}  // namespace spindrift
