#include "pipelines/observation/oscillation.h"

#include <cmath>
#include <vector>

#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr std::size_t kWindow = 64;
constexpr std::size_t kFewest = 10;
// A full window changes little with fewer new values, so the noise is updated this rarely.
constexpr int kStale = 4;
// A step or a ramp crosses the middle once.
constexpr int kFewestCrossings = 3;
// Half the quartile distance has a sigma of 1.2 over the root of the number of values.
constexpr double kSignificant = 4.0 * 1.2;

double noise_of(const std::deque<double>& recent) {
  if (recent.size() < kFewest) {
    return 1.0;
  }
  std::vector<double> values{recent.begin(), recent.end()};
  const std::size_t quarter = values.size() / 4;
  const double lower = in_order_at(values, quarter);
  const double upper = in_order_at(values, values.size() - 1 - quarter);
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

void Oscillation::add(double whitened) {
  recent_.push_back(whitened);
  const bool is_full = recent_.size() > kWindow;
  if (is_full) {
    recent_.pop_front();
  }
  if (!is_full || ++stale_ == kStale) {
    stale_ = 0;
    noise_ = noise_of(recent_);
  }
}

}  // namespace spindrift
