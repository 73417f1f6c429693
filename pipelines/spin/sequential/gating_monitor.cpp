#include "pipelines/spin/sequential/gating_monitor.h"

#include <algorithm>
#include <iterator>

namespace spindrift {
namespace {

// Weight of one edge, or of one revolution, in the share of gated ones.
constexpr double kRecentEdge = 1.0 / 60.0;
constexpr double kRecentRevolution = 0.1;
constexpr double kMost = 0.5;
constexpr double kMany = 1.0 / 3.0;

}  // namespace

void GatingMonitor::note(const EdgeStatistics& tally) {
  const auto gated = static_cast<double>(tally.gated.count());
  const double edges = gated + static_cast<double>(tally.accepted.count());
  share_ += kRecentEdge * (gated - edges * share_);
  // Of the first edges and revolutions the plain mean: what starts wrong says so at once.
  edges_ += edges;
  share_from_the_start_ +=
      std::max(kRecentEdge, 1.0 / std::max(1.0, edges_)) * (gated - edges * share_from_the_start_);
  const double recent = std::max(kRecentRevolution, 1.0 / static_cast<double>(revolutions_ + 1));
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    double& share = channel_share_.at(channel);
    share += recent * ((tally.gated.test(channel) ? 1.0 : 0.0) - share);
  }
  gated_ += static_cast<std::int64_t>(tally.gated.count());
  ++revolutions_;
}

bool GatingMonitor::most_gated() const { return share_ > kMost; }

bool GatingMonitor::many_gated() const { return share_from_the_start_ > kMany; }

std::optional<PulseChannel> GatingMonitor::channel_mostly_gated() const {
  const auto* const worst = std::max_element(channel_share_.begin(), channel_share_.end());
  return *worst > kMost ? std::optional{static_cast<PulseChannel>(
                              std::distance(channel_share_.begin(), worst))}
                        : std::nullopt;
}

}  // namespace spindrift
