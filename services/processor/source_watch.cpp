#include "services/processor/source_watch.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace spindrift {

SourceWatch::Verdict SourceWatch::judge(const Origin& origin, TaiTime t, const Moment& moment) {
  Source& source = source_of(origin, moment);
  const auto others = reach_of_others(source, moment.now);
  const Place place = place_of(source, others, t, moment.now);
  if (place != Place::Level) {
    note_apart(source, t, true, moment);
    tell(*last_, t, others, moment);
  } else {
    note_level(source, t, moment);
  }
  if (place == Place::Apart) {
    return Verdict::Apart;
  }
  return count_of(source.held) > 0 ? Verdict::Healed : Verdict::InTime;
}

SourceWatch::Place SourceWatch::place_of(const Source& source, std::optional<Reach> others,
                                         TaiTime t, Instant now) const {
  // In a replay a pause says nothing, so there a paused source must not hold the others back.
  auto pass = reach_of_pass(now);
  if (others && (pace_.is_of_the_clock || !pass)) {
    pass = others;
  }
  if (!pass || (!others && source.carries && t > pass->from)) {
    return Place::Level;
  }
  if (t > later_by(pass->to, pace_.ahead) || later_by(t, kApart) < pass->from) {
    return Place::Apart;
  }
  return others && later_by(t, pace_.ahead) < pass->from ? Place::Late : Place::Level;
}

void SourceWatch::note_level(Source& source, TaiTime t, const Moment& moment) {
  source.time.advance_to(t);
  pass_.advance_to(t);
  pass_heard_ = moment.now;
  ++carried_;
  source.carries = true;
  source.apart_since.reset();
  if (source.time.time()) {
    carrier_ = &last_->first;
  }
  if (source.told && source.time.goes_on()) {
    source.told = false;
    news_.push_back({.source = last_->first, .t = t, .pass = t, .healed = true});
  }
}

/// @param counts Whether the sample counts towards `has_last_word`.
void SourceWatch::note_apart(Source& source, TaiTime t, bool counts, const Moment& moment) const {
  source.carries = false;
  source.apart_since = source.apart_since.value_or(moment.now);
  if (source.carried != carried_) {
    source.carried = carried_;
    source.alone = 0;
  }
  if (source.time.advance_to(t) && counts) {
    ++source.alone;
  }
}

/// Reports a source as apart. One that no other source contradicts is left to `successor`.
void SourceWatch::tell(Entry& entry, TaiTime t, std::optional<Reach> others, const Moment& moment) {
  Source& source = entry.second;
  const bool may_catch_up =
      others && t < others->from && moment.now - *source.apart_since < pace_.silence;
  if (source.told || !others || may_catch_up) {
    return;
  }
  source.told = true;
  news_.push_back({.source = entry.first, .t = t, .pass = others->from, .healed = false});
}

void SourceWatch::hear(const Origin& origin, const Moment& moment) {
  if (const auto known = sources_.find({origin.source, origin.session}); known != sources_.end()) {
    known->second.heard = moment.now;
  }
}

TelemetryValues SourceWatch::take_held(const Origin& origin) {
  TelemetryValues held =
      std::exchange(sources_.at({origin.source, origin.session}).held, TelemetryValues{});
  held_ -= count_of(held);
  const TaiTime end = later_by(pass_.time().value_or(TaiTime::max()), kApart);
  held.for_each([end](auto& of_kind) {
    std::erase_if(of_kind, [end](const auto& arrived) { return arrived.value.t > end; });
  });
  return held;
}

bool SourceWatch::has_last_word(const Source& source) const {
  return source.apart_since && source.time.goes_on() && source.carried == carried_ &&
         source.alone >= PassWatch::kEnoughToAccept;
}

bool SourceWatch::can_follow(const Source& source, const Moment& moment) const {
  if (!source.apart_since || !source.time.goes_on() || !pass_.time()) {
    return false;
  }
  const Reach it = reach(source.time.recent(), source.heard, moment.now);
  const bool may_catch_up = it.from <= *pass_.time() &&
                            moment.now - *source.apart_since < pace_.silence &&
                            vote_of_host(it, moment) <= 0;
  if (may_catch_up) {
    return false;
  }
  return reach_of_others(source, moment.now) ? lead_over_pass(it, moment) > 0
                                             : has_last_word(source);
}

std::optional<SourceId> SourceWatch::successor(const Moment& moment) const {
  const Entry* best = nullptr;
  std::ptrdiff_t most = 0;
  for (const Entry& entry : sources_) {
    if (!can_follow(entry.second, moment)) {
      continue;
    }
    const std::ptrdiff_t lead =
        lead_over_pass(reach(entry.second.time.recent(), entry.second.heard, moment.now), moment);
    if (best == nullptr || lead > most) {
      best = &entry;
      most = lead;
    }
  }
  return best == nullptr ? std::nullopt : std::optional{best->first};
}

std::optional<SourceId> SourceWatch::successor_at_end(std::size_t samples) const {
  const auto found = std::find_if(sources_.begin(), sources_.end(), [&](const Entry& entry) {
    return has_last_word(entry.second) && count_of(entry.second.held) > samples;
  });
  return found == sources_.end() ? std::nullopt : std::optional{found->first};
}

std::optional<SourceWatch::Instant> SourceWatch::next_decision() const {
  std::optional<Instant> silent;
  std::optional<Instant> caught_up;
  for (const auto& [id, source] : sources_) {
    if (source.carries && source.time.time()) {
      silent = std::max(silent.value_or(source.heard), source.heard);
    }
    if (has_last_word(source)) {
      const bool behind = pass_.time() && source.time.recent() <= *pass_.time();
      const Instant from = behind ? *source.apart_since : source.heard - pace_.silence;
      caught_up = std::min(caught_up.value_or(from), from);
    }
  }
  if (!caught_up || !pass_.time()) {
    return std::nullopt;
  }
  return std::max(silent.value_or(*caught_up), *caught_up) + pace_.silence;
}

TelemetryValues SourceWatch::follow(const SourceId& successor) {
  Source& source = sources_.at(successor);
  const Reach it = reach(source.time.recent(), source.heard, source.heard);
  for (auto& [id, other] : sources_) {
    other.carries =
        other.carries &&
        agree(reach(other.time.recent(), other.heard, std::max(other.heard, source.heard)), it);
  }
  source.carries = true;
  source.apart_since.reset();
  source.told = false;
  carrier_ = &sources_.find(successor)->first;
  pass_ = source.time;
  pass_heard_ = source.heard;
  ++carried_;
  held_ -= count_of(source.held);
  return std::exchange(source.held, TelemetryValues{});
}

std::vector<std::pair<SourceWatch::News, SourceWatch::Instant>> SourceWatch::apart() const {
  std::vector<std::pair<News, Instant>> all;
  for (const auto& [id, source] : sources_) {
    if (source.told && source.apart_since && pass_.time()) {
      all.push_back(
          {{.source = id, .t = source.time.recent(), .pass = *pass_.time(), .healed = false},
           source.heard});
    }
  }
  return all;
}

void SourceWatch::restore_carrier(const Origin& origin, const Moment& moment) {
  Source& source = source_of(origin, moment);
  source.carries = true;
  source.time = pass_;
  carrier_ = &last_->first;
}

SourceWatch::Source& SourceWatch::source_of(const Origin& origin, const Moment& moment) {
  if (last_ == nullptr || last_->first.session != origin.session ||
      last_->first.name != origin.source) {
    const SourceId id{origin.source, origin.session};
    if (!sources_.contains(id) && sources_.size() == kMostSources) {
      const auto oldest =
          std::min_element(sources_.begin(), sources_.end(), [](const Entry& a, const Entry& b) {
            return std::pair{a.second.carries, a.second.heard} <
                   std::pair{b.second.carries, b.second.heard};
          });
      carrier_ = carrier_ == &oldest->first ? nullptr : carrier_;
      held_ -= count_of(oldest->second.held);
      sources_.erase(oldest);
    }
    last_ = &*sources_.try_emplace(id).first;
  }
  last_->second.heard = moment.now;
  return last_->second;
}

void SourceWatch::make_room() {
  if (held_ < kMostHeld) {
    return;
  }
  const auto most =
      std::max_element(sources_.begin(), sources_.end(), [](const Entry& a, const Entry& b) {
        return count_of(a.second.held) < count_of(b.second.held);
      });
  held_ -= count_of(most->second.held);
  most->second.held = {};
}

SourceWatch::Reach SourceWatch::reach(TaiTime t, Instant heard, Instant now) const {
  return {.from = t, .to = pace_.is_of_the_clock ? later_by(t, now - heard) : t};
}

std::optional<SourceWatch::Reach> SourceWatch::reach_of_pass(Instant now) const {
  return pass_.time() ? std::optional{reach(*pass_.time(), pass_heard_, now)} : std::nullopt;
}

/// Returns the reach of the other sources that carry the pass: as far as the furthest has come.
std::optional<SourceWatch::Reach> SourceWatch::reach_of_others(const Source& source,
                                                               Instant now) const {
  std::optional<Reach> all;
  for (const auto& [id, other] : sources_) {
    if (&other != &source && other.carries && other.time.time() && is_heard(other, now)) {
      const Reach one = reach(*other.time.time(), other.heard, now);
      all =
          all ? Reach{.from = std::max(all->from, one.from), .to = std::max(all->to, one.to)} : one;
    }
  }
  return all;
}

bool SourceWatch::agree(const Reach& one, const Reach& other) const {
  return one.from <= later_by(other.to, pace_.ahead) && other.from <= later_by(one.to, pace_.ahead);
}

bool SourceWatch::is_heard(const Source& source, Instant now) const {
  return now - source.heard < pace_.silence;
}

/// Counts names, not sessions: a source that starts session after session has one vote.
std::size_t SourceWatch::supporters(const Reach& reach_of_one, Instant now) const {
  std::set<std::string_view> names;
  for (const auto& [id, source] : sources_) {
    if (source.time.goes_on() && is_heard(source, now) &&
        agree(reach(source.time.recent(), source.heard, now), reach_of_one)) {
      names.insert(id.name);
    }
  }
  return names.size();
}

/// Returns 1 if the host's clock is nearer to `there`, -1 if it is nearer to the pass, and 0 if it
/// is far from both or equally near.
std::ptrdiff_t SourceWatch::vote_of_host(const Reach& there, const Moment& moment) const {
  if (!moment.host || !pass_.time()) {
    return 0;
  }
  const auto distance = [&](const Reach& reach) {
    return std::max({span_between(*moment.host, reach.from), span_between(reach.to, *moment.host),
                     std::chrono::nanoseconds{0}});
  };
  const auto nearer = [&](const Reach& reach, const Reach& than) {
    return distance(reach) <= kHostApart && distance(reach) + pace_.ahead < distance(than);
  };
  const Reach pass = *reach_of_pass(moment.now);
  return nearer(there, pass) ? 1 : nearer(pass, there) ? -1 : 0;
}

std::ptrdiff_t SourceWatch::lead_over_pass(const Reach& there, const Moment& moment) const {
  const auto of = [&](const Reach& reach) {
    return static_cast<std::ptrdiff_t>(supporters(reach, moment.now));
  };
  return of(there) - of(*reach_of_pass(moment.now)) + vote_of_host(there, moment);
}

}  // namespace spindrift
