#include "services/archive/recent_durations.h"

#include <algorithm>

namespace spindrift {

void RecentDurations::add(double duration_ms) {
  if (durations_ms_.size() < capacity_) {
    durations_ms_.push_back(duration_ms);
    return;
  }
  durations_ms_.at(oldest_) = duration_ms;
  oldest_ = (oldest_ + 1) % capacity_;
}

std::optional<double> RecentDurations::percentile_ms(std::size_t percent) const {
  if (durations_ms_.empty()) {
    return std::nullopt;
  }
  std::vector<double> sorted_ms = durations_ms_;
  const std::size_t rank = (sorted_ms.size() * percent + 99) / 100;
  const auto nth = sorted_ms.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(sorted_ms.begin(), nth, sorted_ms.end());
  return *nth;
}

}  // namespace spindrift
