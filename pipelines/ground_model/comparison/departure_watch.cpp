#include "pipelines/ground_model/comparison/departure_watch.h"

#include <cmath>
#include <utility>

namespace spindrift {
namespace {

/// @param held_s How long it was silent.
Evidence evidence_of(const ComparedSample& sample, const ComparedChannel& channel,
                     double band_sigmas, double held_s) {
  if (!sample.value) {
    return {.value = held_s,
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

}  // namespace

DepartureWatch::DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas)
    : band_sigmas_{band_sigmas} {
  for (const ComparedChannel& channel : channels) {
    const Holding holding{.raise_s = channel.holding_s, .clear_s = channel.holding_s};
    watched_.push_back(
        {.comparison = {.channel = channel},
         .watch = ConditionWatch{AlertCode::ModelDeparture, channel.unit, holding, channel.name}});
  }
}

std::optional<ConditionChange> DepartureWatch::see(const ComparedSample& sample) {
  Watched& watched = watched_.at(sample.channel);
  const double off_sigmas = sample.value ? std::abs(sample.value->normalised()) : 0.0;
  const bool is_away = !sample.came || off_sigmas >= band_sigmas_;
  if (sample.value) {
    watched.comparison.residuals.add(*sample.value);
    watched.comparison.outside += is_away ? 1 : 0;
  }
  const bool is_back = off_sigmas <= ConditionWatch::kClearShare * band_sigmas_;
  if ((!is_away && !is_back) || (watched.last && sample.t < *watched.last)) {
    return std::nullopt;
  }
  if (is_away && watched.leaving &&
      seconds_between(*watched.last, sample.t) > watched.comparison.channel.holding_s) {
    begin_anew(sample.t, watched);
  }
  watched.last = sample.t;
  return judge(sample, is_away, watched);
}

/// Nobody knows what was in between. What is said of the channel stays said.
void DepartureWatch::begin_anew(TaiTime t, Watched& watched) {
  watched.watch.see(t, false);
  watched.leaving.reset();
  watched.away = 0;
}

std::optional<ConditionChange> DepartureWatch::judge(const ComparedSample& sample, bool is_away,
                                                     Watched& watched) const {
  const auto evidence = [&](double held_s) {
    return evidence_of(sample, watched.comparison.channel, band_sigmas_, held_s);
  };
  watched.away = is_away ? watched.away + 1 : 0;
  if (!is_away) {
    watched.leaving.reset();
  } else if (!watched.leaving) {
    watched.leaving = evidence(0.0);
  } else if (watched.away < kLeastSamples) {
    return std::nullopt;
  }
  auto change = watched.watch.see(sample.t, is_away);
  if (!change) {
    return std::nullopt;
  }
  const TaiTime since = change->evidence.since;
  if (change->change == Change::Cleared) {
    change->evidence = evidence(0.0);
  } else {
    change->evidence = *watched.leaving;
    if (!watched.leaving->sigma) {
      change->evidence.value = seconds_between(since, sample.t);
    }
  }
  change->evidence.since = since;
  change->evidence.last = sample.t;
  if (change->change == Change::Raised && !watched.comparison.departure) {
    watched.comparison.departure = change->evidence;
  }
  return change;
}

std::vector<ChannelComparison> DepartureWatch::channels() const {
  std::vector<ChannelComparison> all;
  for (const Watched& watched : watched_) {
    all.push_back(watched.comparison);
  }
  return all;
}

}  // namespace spindrift
