#include "services/processor/source_watch.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace spindrift {

SourceWatch::Verdict SourceWatch::judge(const Origin& origin, TaiTime t, const Moment& moment) {
  Source& source = source_of(origin, moment);
  const auto others = time_of_others(source, moment.now);
  if (!is_in_time(source, others, t)) {
    note_apart(source, t, true, moment);
    tell(*last_, t, others, moment);
    return Verdict::Apart;
  }
  source.time.see(t);
  pass_.see(t);
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
  return count_of(source.held) > 0 ? Verdict::Healed : Verdict::InTime;
}

bool SourceWatch::is_in_time(const Source& source, std::optional<TaiTime> others, TaiTime t) const {
  const auto pass = pass_.time() ? pass_.time() : others;
  return !pass || !are_apart(*pass, t) || (!others && source.carries && t > *pass);
}

/// @param counts Whether it may be the last word.
void SourceWatch::note_apart(Source& source, TaiTime t, bool counts, const Moment& moment) {
  source.carries = false;
  source.apart_since = source.apart_since.value_or(moment.now);
  if (source.carried != carried_) {
    source.carried = carried_;
    source.alone = 0;
  }
  if (source.time.see(t) && counts) {
    ++source.alone;
  }
}

/// Of those that nobody contradicts, `successor` decides first.
void SourceWatch::tell(Entry& entry, TaiTime t, std::optional<TaiTime> others,
                       const Moment& moment) {
  Source& source = entry.second;
  const auto pass = pass_.time() ? pass_.time() : others;
  if (source.told || !others || (t < *pass && moment.now - *source.apart_since < kSilence)) {
    return;
  }
  source.told = true;
  news_.push_back({.source = entry.first, .t = t, .pass = *pass, .healed = false});
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
  const TaiTime t = source.time.recent();
  const bool lasts = t > *pass_.time() || moment.now - *source.apart_since >= kSilence;
  const auto others = time_of_others(source, moment.now);
  if (!others) {
    return lasts && has_last_word(source);
  }
  const bool has_host = moment.host && !are_apart(t, *moment.host, kHostApart) &&
                        are_apart(*pass_.time(), *moment.host, kHostApart);
  return has_host || (lasts && supporters(t, moment.now) > carriers(moment.now));
}

std::optional<SourceId> SourceWatch::successor(const Moment& moment) const {
  const Entry* best = nullptr;
  std::pair<bool, std::size_t> most;
  for (const Entry& entry : sources_) {
    if (!can_follow(entry.second, moment)) {
      continue;
    }
    const TaiTime t = entry.second.time.recent();
    const std::pair speaks_for_it{moment.host && !are_apart(t, *moment.host, kHostApart),
                                  supporters(t, moment.now)};
    if (best == nullptr || speaks_for_it > most) {
      best = &entry;
      most = speaks_for_it;
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
      const bool behind = pass_.time() && source.time.recent() < *pass_.time();
      const Instant from = behind ? *source.apart_since : source.heard - kSilence;
      caught_up = std::min(caught_up.value_or(from), from);
    }
  }
  if (!caught_up || !pass_.time()) {
    return std::nullopt;
  }
  return std::max(silent.value_or(*caught_up), *caught_up) + kSilence;
}

TelemetryValues SourceWatch::follow(const SourceId& successor) {
  Source& source = sources_.at(successor);
  for (auto& [id, other] : sources_) {
    other.carries = other.carries && !are_apart(other.time.recent(), source.time.recent());
  }
  source.carries = true;
  source.apart_since.reset();
  source.told = false;
  carrier_ = &sources_.find(successor)->first;
  pass_ = source.time;
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
      const auto oldest = std::min_element(
          sources_.begin(), sources_.end(),
          [](const Entry& a, const Entry& b) { return a.second.heard < b.second.heard; });
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

std::optional<TaiTime> SourceWatch::time_of_others(const Source& source, Instant now) const {
  std::optional<TaiTime> latest;
  for (const auto& [id, other] : sources_) {
    if (&other != &source && other.carries && other.time.time() && now - other.heard < kSilence) {
      latest = std::max(latest.value_or(*other.time.time()), *other.time.time());
    }
  }
  return latest;
}

/// By name: one that begins session after session is one.
std::size_t SourceWatch::supporters(TaiTime t, Instant now) const {
  std::set<std::string_view> names;
  for (const auto& [id, source] : sources_) {
    if (source.time.goes_on() && now - source.heard < kSilence &&
        !are_apart(source.time.recent(), t)) {
      names.insert(id.name);
    }
  }
  return names.size();
}

std::size_t SourceWatch::carriers(Instant now) const {
  std::set<std::string_view> names;
  for (const auto& [id, source] : sources_) {
    if (source.carries && source.time.time() && now - source.heard < kSilence) {
      names.insert(id.name);
    }
  }
  return names.size();
}

}  // namespace spindrift
