#include "pipelines/ground_model/comparison/departure_watch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spindrift {
namespace {

Evidence evidence_of(const ComparedSample& sample, const ComparedChannel& channel,
                     double band_sigmas) {
  if (!sample.value) {
    return {.value = 0.0,
            .limit = channel.holding_s,
            .unit = "s silent",
            .since = sample.t,
            .last = sample.t};
  }
  return {.value = std::abs(sample.value->residual()),
          .limit = band_sigmas * sample.value->sigma,
          .unit = channel.unit,
          .since = sample.t,
          .last = sample.t,
          .sigma = sample.value->sigma};
}

/// Returns the index from which on samples that are away outnumber the others by most.
/// @param window Not empty.
template <class Window>
std::size_t change_point(const Window& window) {
  std::size_t best = window.size() - 1;
  int sum = 0;
  int most = 0;
  for (std::size_t i = window.size(); i-- > 0;) {
    sum += window[i].is_away ? 1 : -1;
    if (sum >= most) {
      most = sum;
      best = i;
    }
  }
  return best;
}

}  // namespace

DepartureWatch::DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas)
    : band_sigmas_{band_sigmas} {
  for (const ComparedChannel& channel : channels) {
    watched_.push_back(
        {.comparison = {.channel = channel},
         .watch = ConditionWatch{
             AlertCode::ModelDeparture, channel.unit, {.clear_s = kClear_s}, channel.name}});
  }
}

std::optional<ConditionChange> DepartureWatch::evaluate(const ComparedSample& sample) {
  Watched& watched = watched_.at(sample.channel);
  ChannelComparison& comparison = watched.comparison;
  const bool is_sample_away =
      !sample.came || (sample.value && std::abs(sample.value->normalised()) >= band_sigmas_);
  if (sample.value) {
    comparison.residuals.add(*sample.value);
    comparison.outside += is_sample_away ? 1 : 0;
  }
  const auto& window = watched.window;
  if (!window.empty() && sample.t < window.back().evidence.last) {
    return std::nullopt;
  }
  const Judged now{is_sample_away, evidence_of(sample, comparison.channel, band_sigmas_)};
  const bool has_values = !comparison.channel.unit.empty();
  const auto is_there = has_values ? is_away(now, watched) : is_silent(now, watched);
  auto change = is_there ? watched.watch.update(sample.t, *is_there) : std::nullopt;
  if (!change) {
    return std::nullopt;
  }
  const bool is_raised = change->change == Change::Raised;
  change->evidence = is_raised ? window[change_point(window)].evidence : now.evidence;
  change->evidence.last = sample.t;
  if (is_raised && !change->evidence.sigma) {
    change->evidence.value = seconds_between(change->evidence.since, sample.t);
  }
  if (is_raised && !comparison.departure) {
    comparison.departure = change->evidence;
  }
  return change;
}

std::optional<bool> DepartureWatch::is_away(const Judged& now, Watched& watched) {
  auto& window = watched.window;
  while (!window.empty() && seconds_between(window.front().evidence.last, now.evidence.last) >
                                watched.comparison.channel.holding_s) {
    window.pop_front();
  }
  window.push_back(now);
  const auto away =
      std::count_if(window.begin(), window.end(), [](const Judged& one) { return one.is_away; });
  const auto all = static_cast<std::ptrdiff_t>(window.size());
  if (away - (all - away) >= kAhead) {
    return true;
  }
  return 4 * away <= all ? std::optional{false} : std::nullopt;
}

std::optional<bool> DepartureWatch::is_silent(const Judged& now, Watched& watched) {
  auto& window = watched.window;
  if (!now.is_away) {
    window.clear();
    return false;
  }
  const double holding_s = watched.comparison.channel.holding_s;
  if (!window.empty() &&
      seconds_between(window.back().evidence.last, now.evidence.last) > holding_s) {
    window.clear();  // The sensor may have sent in such a gap.
  }
  if (window.size() > 1) {
    window.pop_back();
  }
  window.push_back(now);
  const double silent_s = seconds_between(window.front().evidence.last, now.evidence.last);
  return silent_s >= holding_s ? std::optional{true} : std::nullopt;
}

std::vector<ChannelComparison> DepartureWatch::channels() const {
  std::vector<ChannelComparison> all;
  for (const Watched& watched : watched_) {
    all.push_back(watched.comparison);
  }
  return all;
}

}  // namespace spindrift
