#include "services/serving/silence_watch.h"

#include <algorithm>

namespace spindrift {

std::optional<SilenceWatch::Instant> SilenceWatch::next() const {
  const auto first = std::min_element(
      last_.begin(), last_.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return first == last_.end() ? std::nullopt : std::optional{first->second + kSilence};
}

std::vector<std::string> SilenceWatch::take_silent(Instant now) {
  std::vector<std::string> silent;
  std::erase_if(last_, [&](const auto& last) {
    const bool is_silent = now >= last.second + kSilence;
    if (is_silent) {
      silent.push_back(last.first);
    }
    return is_silent;
  });
  return silent;
}

}  // namespace spindrift
