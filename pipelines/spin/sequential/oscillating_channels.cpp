#include "pipelines/spin/sequential/oscillating_channels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr std::size_t kWindow = 64;
constexpr std::size_t kFewest = 10;
// Of a full window's edges, so many more hardly change it.
constexpr int kStale = 4;
// A step or a ramp crosses the middle once.
constexpr int kFewestCrossings = 3;
// Half the distance of so many has itself a sigma of 1.2 over the root of their number.
constexpr double kSignificant = 4.0 * 1.2;

double noise_of(const std::deque<double>& recent) {
  if (recent.size() < kFewest) {
    return 1.0;
  }
  std::vector<double> sorted{recent.begin(), recent.end()};
  std::sort(sorted.begin(), sorted.end());
  const double lower = sorted[sorted.size() / 4];
  const double upper = sorted[sorted.size() - 1 - sorted.size() / 4];
  const double sigma = kSigmaPerMad * 0.5 * (upper - lower);
  if (sigma < 1.0 + kSignificant / std::sqrt(static_cast<double>(recent.size()))) {
    return 1.0;
  }
  const double middle = 0.5 * (lower + upper);
  int crossings = 0;
  for (std::size_t i = 1; i < recent.size(); ++i) {
    crossings += (recent[i] > middle) != (recent[i - 1] > middle) ? 1 : 0;
  }
  return crossings >= kFewestCrossings ? sigma * sigma : 1.0;
}

}  // namespace

void OscillatingChannels::note(const EdgeStatistics& tally) {
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    if (const auto& innovation = tally.innovations.at(channel)) {
      std::deque<double>& recent = recent_.at(channel);
      recent.push_back(*innovation);
      const bool full = recent.size() > kWindow;
      if (full) {
        recent.pop_front();
      }
      if (int& stale = stale_.at(channel); !full || ++stale == kStale) {
        stale = 0;
        noise_.at(channel) = noise_of(recent);
      }
    }
  }
}

}  // namespace spindrift
