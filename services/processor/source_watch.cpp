#include "services/processor/source_watch.h"

#include <algorithm>
#include <tuple>

namespace spindrift {

SourceWatch::Verdict SourceWatch::judge(const Origin& origin, TaiTime t, const Moment& moment) {
  Source& source = source_of(origin, moment);
  if (!leader_ && (!moment.host || (in_time_ == 0 && !is_near(t, moment.host)))) {
    leader_ = last_->first;
  }
  const auto at = clock(moment);
  if (!at || is_near(t, at) || (leader_ == last_->first && t > *at)) {
    note_in_time(t, moment.now);
    return count_of(source.held) > 0 ? Verdict::Healed : Verdict::InTime;
  }
  const bool may_be_sent_again =
      t < *at && later_by(t, kSentAgain) >= *at && moment.now - source.since < limits_.silence;
  if (may_be_sent_again && !is_near(t, moment.host)) {
    return Verdict::InTime;
  }
  note_apart(source, t, true, moment.now);
  tell(t, *at, moment.now);
  return Verdict::Apart;
}

std::optional<TaiTime> SourceWatch::clock(const Moment& moment) const {
  return leader_ ? sources_.at(*leader_).time.time() : moment.host;
}

void SourceWatch::note_in_time(TaiTime t, Instant now) {
  auto& [id, source] = *last_;
  source.time.advance_to(t);
  pass_.advance_to(t);
  ++in_time_;
  source.since = now;
  source.is_in_time = true;
  source.apart_since.reset();
  if (source.told && source.time.goes_on()) {
    source.told.reset();
    news_.push_back({.source = id, .t = t, .clock = t, .healed = true});
  }
}

/// @param counts Whether the sample counts towards `has_last_word`.
void SourceWatch::note_apart(Source& source, TaiTime t, bool counts, Instant now) const {
  source.is_in_time = false;
  source.apart_since = source.apart_since.value_or(now);
  if (source.in_time != in_time_) {
    source.in_time = in_time_;
    source.alone = 0;
  }
  if (source.time.advance_to(t) && counts) {
    ++source.alone;
  }
}

/// Reports the source as apart. One that is behind may catch up at first.
void SourceWatch::tell(TaiTime t, TaiTime clock, Instant now) {
  auto& [id, source] = *last_;
  if (!source.told && (t > clock || now - *source.apart_since >= limits_.silence)) {
    source.told = clock;
    news_.push_back({.source = id, .t = t, .clock = clock, .healed = false});
  }
}

void SourceWatch::hear(const Origin& origin, const Moment& moment) {
  if (const auto known = sources_.find({origin.source, origin.session}); known != sources_.end()) {
    known->second.heard = moment.now;
  }
}

TelemetryValues SourceWatch::take_held(const SourceId& source) {
  TelemetryValues held = std::exchange(sources_.at(source).held, TelemetryValues{});
  held_ -= count_of(held);
  const TaiTime end = later_by(pass_.time().value_or(TaiTime::max()), limits_.within);
  held.for_each([end](auto& of_kind) {
    std::erase_if(of_kind, [end](const auto& arrived) { return arrived.value.t > end; });
  });
  return held;
}

bool SourceWatch::is_near(TaiTime t, std::optional<TaiTime> clock) const {
  return clock && !are_apart(t, *clock, limits_.within);
}

bool SourceWatch::has_last_word(const Source& source) const {
  return source.apart_since && source.time.goes_on() && source.in_time == in_time_ &&
         source.alone >= PassWatch::kEnoughToAccept;
}

/// Returns when a source that is in time was last heard; empty when none is.
std::optional<SourceWatch::Instant> SourceWatch::last_in_time() const {
  std::optional<Instant> last;
  for (const auto& [id, source] : sources_) {
    if (source.is_in_time) {
      last = std::max(last.value_or(source.heard), source.heard);
    }
  }
  return last;
}

std::optional<SourceId> SourceWatch::successor(const Moment& moment) const {
  const auto last = last_in_time();
  const bool all_silent = !last || moment.now - *last >= limits_.silence;
  const Entry* first = nullptr;
  for (const Entry& entry : sources_) {
    const auto& [id, source] = entry;
    const bool is_heard = moment.now - source.heard < limits_.silence;
    if (leader_ && is_heard && source.time.goes_on() &&
        is_near(source.time.recent(), moment.host)) {
      return id;
    }
    if (all_silent && has_last_word(source) &&
        (first == nullptr || *source.apart_since < *first->second.apart_since)) {
      first = &entry;
    }
  }
  return first == nullptr ? std::nullopt : std::optional{first->first};
}

std::optional<SourceId> SourceWatch::caught_up_with() const {
  const auto found = std::find_if(sources_.begin(), sources_.end(), [&](const Entry& entry) {
    const Source& source = entry.second;
    return leader_ && count_of(source.held) > 0 && source.time.goes_on() &&
           is_near(source.time.recent(), pass_.time());
  });
  return found == sources_.end() ? std::nullopt : std::optional{found->first};
}

std::optional<SourceId> SourceWatch::successor_at_end(std::size_t samples) const {
  const auto found = std::find_if(sources_.begin(), sources_.end(), [&](const Entry& entry) {
    return leader_ && has_last_word(entry.second) && count_of(entry.second.held) > samples;
  });
  return found == sources_.end() ? std::nullopt : std::optional{found->first};
}

std::optional<SourceWatch::Instant> SourceWatch::next_decision() const {
  const bool waits = std::any_of(sources_.begin(), sources_.end(), [this](const Entry& entry) {
    return has_last_word(entry.second);
  });
  const auto last = last_in_time();
  return waits && last ? std::optional{*last + limits_.silence} : std::nullopt;
}

TelemetryValues SourceWatch::follow(const SourceId& successor, const Moment& moment) {
  for (auto& [id, other] : sources_) {
    other.is_in_time = false;
  }
  Source& source = sources_.at(successor);
  source.since = source.heard;
  source.is_in_time = true;
  source.apart_since.reset();
  source.told.reset();
  leader_ = is_near(source.time.recent(), moment.host) ? std::nullopt : std::optional{successor};
  pass_ = source.time;
  ++in_time_;
  held_ -= count_of(source.held);
  return std::exchange(source.held, TelemetryValues{});
}

std::vector<std::pair<SourceWatch::News, SourceWatch::Instant>> SourceWatch::apart() const {
  std::vector<std::pair<News, Instant>> all;
  for (const auto& [id, source] : sources_) {
    if (source.told && source.apart_since) {
      all.push_back(
          {{.source = id, .t = source.time.recent(), .clock = *source.told, .healed = false},
           source.heard});
    }
  }
  return all;
}

void SourceWatch::restore_in_time(const Origin& origin, const Moment& moment) {
  Source& source = source_of(origin, moment);
  source.is_in_time = true;
  source.time = pass_;
  ++in_time_;
}

SourceWatch::Source& SourceWatch::source_of(const Origin& origin, const Moment& moment) {
  if (moment.host) {
    limits_ = by_clock_;
  }
  if (last_ == nullptr || last_->first.session != origin.session ||
      last_->first.name != origin.source) {
    const SourceId id{origin.source, origin.session};
    if (!sources_.contains(id) && sources_.size() == kMostSources) {
      const auto oldest = std::min_element(
          sources_.begin(), sources_.end(), [this](const Entry& a, const Entry& b) {
            const auto worth = [this](const Entry& entry) {
              return std::tuple{entry.first == leader_, entry.second.is_in_time,
                                entry.second.heard};
            };
            return worth(a) < worth(b);
          });
      held_ -= count_of(oldest->second.held);
      sources_.erase(oldest);
    }
    last_ = &*sources_.try_emplace(id).first;
  }
  Source& source = last_->second;
  if (moment.now - source.heard >= limits_.silence) {
    source.since = moment.now;
  }
  source.heard = moment.now;
  return source;
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

}  // namespace spindrift
