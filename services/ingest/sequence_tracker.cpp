#include "services/ingest/sequence_tracker.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

Arrival SequenceTracker::record(const Origin& origin, const std::string& spacecraft) {
  SequenceCounts& counts = counts_of(origin.source);
  Session& session = session_of(origin);
  session.last_active = ++clock_;
  ++counts.received;
  const Arrival arrival = insert(session, origin.seq, counts);
  if (arrival == Arrival::Duplicate) {
    ++counts.duplicates;
  } else if (is_overtaken(session, spacecraft, origin.seq)) {
    ++counts.disordered;
  }
  return arrival;
}

Arrival SequenceTracker::insert(Session& session, std::uint64_t seq, SequenceCounts& counts) {
  auto& runs = session.runs;
  if (runs.empty()) {
    runs.emplace(seq, seq);
    return Arrival::New;
  }
  const auto last = std::prev(runs.end());
  if (seq > last->second) {
    counts.missing += seq - last->second - 1;
    join_neighbours(session, runs.emplace(seq, seq).first);
    return Arrival::New;
  }
  const auto above = runs.upper_bound(seq);
  if (above != runs.begin() && seq <= std::prev(above)->second) {
    return Arrival::Duplicate;
  }
  if (seq < session.floor) {
    return Arrival::New;
  }
  if (above == runs.begin()) {
    counts.missing += above->first - seq - 1;
  } else {
    --counts.missing;
  }
  join_neighbours(session, runs.emplace(seq, seq).first);
  return Arrival::New;
}

void SequenceTracker::join_neighbours(Session& session,
                                      std::map<std::uint64_t, std::uint64_t>::iterator run) {
  auto& runs = session.runs;
  if (const auto next = std::next(run); next != runs.end() && next->first == run->second + 1) {
    run->second = next->second;
    runs.erase(next);
  }
  if (run != runs.begin()) {
    if (const auto previous = std::prev(run); previous->second + 1 == run->first) {
      previous->second = run->second;
      runs.erase(run);
    }
  }
  if (runs.size() > kMaxRuns) {
    runs.erase(runs.begin());
    session.floor = runs.begin()->first;
  }
}

bool SequenceTracker::is_overtaken(Session& session, const std::string& spacecraft,
                                   std::uint64_t seq) {
  auto& highest = session.highest;
  const bool room = highest.size() < kMaxSpacecraft || highest.contains(spacecraft);
  const auto [place, is_first] = highest.try_emplace(room ? spacecraft : std::string{}, seq);
  if (!is_first && seq < place->second) {
    return true;
  }
  place->second = seq;
  return false;
}

SequenceTracker::Session& SequenceTracker::session_of(const Origin& origin) {
  const std::pair key{origin.source, origin.session};
  if (const auto known = sessions_.find(key); known != sessions_.end()) {
    return known->second;
  }
  if (sessions_.size() == kMaxSessions) {
    sessions_.erase(std::min_element(
        sessions_.begin(), sessions_.end(),
        [](const auto& a, const auto& b) { return a.second.last_active < b.second.last_active; }));
  }
  return sessions_[key];
}

const std::pair<const std::string, SequenceCounts>& SequenceTracker::entry_of(
    const std::string& source) const {
  const auto own = by_source_.find(source);
  return own == by_source_.end() ? *by_source_.find(kOtherSources) : *own;
}

SequenceCounts& SequenceTracker::counts_of(const std::string& source) {
  const bool room = by_source_.size() < kMaxSources || by_source_.contains(source);
  return by_source_[room ? source : kOtherSources];
}

}  // namespace spindrift
