#include "services/ingest/sequence_tracker.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

SequenceCounts& SequenceCounts::operator+=(const SequenceCounts& other) {
  received += other.received;
  missing += other.missing;
  duplicates += other.duplicates;
  disordered += other.disordered;
  return *this;
}

Arrival SequenceTracker::record(const Origin& origin) {
  SequenceCounts& counts = counts_of(origin.source);
  Session& session = session_of(origin);
  session.last_active = ++clock_;
  ++counts.received;
  const Arrival arrival = insert(session, origin.seq, counts);
  if (arrival == Arrival::Duplicate) {
    ++counts.duplicates;
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
  ++counts.disordered;
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

SequenceCounts& SequenceTracker::counts_of(const std::string& source) {
  const bool room = by_source_.size() < kMaxSources || by_source_.contains(source);
  return by_source_[room ? source : kOtherSources];
}

}  // namespace spindrift
