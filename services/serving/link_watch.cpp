#include "services/serving/link_watch.h"

#include <algorithm>

namespace spindrift {

LinkWatch::LinkWatch(const std::vector<std::string>& spacecraft) {
  for (const std::string& id : spacecraft) {
    last_.emplace(id, std::nullopt);
  }
}

void LinkWatch::hear(const std::string& spacecraft, TaiTime t, Instant now) {
  const std::lock_guard lock{mutex_};
  if (const auto found = last_.find(spacecraft); found != last_.end()) {
    found->second = Last{.t = t, .came = now};
  }
}

void LinkWatch::go_on(const std::string& spacecraft, TaiTime t, Instant now) {
  const std::lock_guard lock{mutex_};
  if (const auto found = last_.find(spacecraft); found != last_.end()) {
    found->second = Last{.t = t, .came = std::nullopt};
    counts_from_.insert_or_assign(spacecraft, now + kHeldBack);
  }
}

std::optional<double> LinkWatch::silent_s(const std::string& spacecraft, Instant now) const {
  const std::lock_guard lock{mutex_};
  const auto last = last_.find(spacecraft);
  if (last == last_.end() || !last->second || !last->second->came) {
    return std::nullopt;
  }
  const auto counts_from = counts_from_.find(spacecraft);
  const Instant from = counts_from == counts_from_.end()
                           ? *last->second->came
                           : std::max(*last->second->came, counts_from->second);
  return std::chrono::duration<double>{std::max(now - from, Instant::duration{0})}.count();
}

std::vector<SpacecraftHealth> LinkWatch::report(Instant now) const {
  const std::lock_guard lock{mutex_};
  std::vector<SpacecraftHealth> all;
  for (const auto& [spacecraft, last] : last_) {
    all.push_back({.spacecraft = spacecraft, .link = LinkState::Waiting});
    if (last) {
      all.back().link = LinkState::Stale;
      all.back().last_sample = last->t;
    }
    if (last && last->came) {
      const std::chrono::duration<double> age = now - *last->came;
      all.back().link = age > kStaleAfter ? LinkState::Stale : LinkState::Live;
      all.back().data_age_s = age.count();
    }
  }
  return all;
}

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
