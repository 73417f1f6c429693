#include "services/ingest/sequence_tracker.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

void SequenceTracker::go_on(const Origin& last, std::size_t topic) {
  Session& session = session_of(last, topic);
  session.floor = std::max(session.floor, last.seq + 1);
}

Arrival SequenceTracker::record(const Origin& origin, const std::string& spacecraft,
                                std::size_t topic) {
  if (!last_.is_of(origin, spacecraft, topic)) {
    last_ = place_of(origin, spacecraft, topic);
    changed_.insert(last_.counts);
  }
  SequenceCounts& counts = last_.counts->second;
  last_.session->last_active = ++clock_;
  ++counts.received;
  if (has_jumped(*last_.session, origin.seq)) {
    counts.missing += last_.session->runs.empty() ? 0 : 1;
    *last_.session = {.runs = {}, .floor = 0, .highest = {}, .last_active = clock_};
    last_.highest = &highest_of(*last_.session, spacecraft, origin.seq);
  }
  const Arrival arrival = insert(*last_.session, origin.seq, counts);
  if (arrival == Arrival::Duplicate) {
    ++counts.duplicates;
  } else if (origin.seq < *last_.highest) {
    ++counts.disordered;
  } else {
    *last_.highest = origin.seq;
  }
  return arrival;
}

std::map<std::string, SequenceCounts> SequenceTracker::take_changed() {
  std::map<std::string, SequenceCounts> counts;
  for (const SourceEntry* entry : changed_) {
    counts.insert(*entry);
  }
  changed_.clear();
  last_ = {};
  return counts;
}

SequenceTracker::Place SequenceTracker::place_of(const Origin& origin,
                                                 const std::string& spacecraft, std::size_t topic) {
  Session& session = session_of(origin, topic);
  return {.source = origin.source,
          .session_number = origin.session,
          .topic = topic,
          .spacecraft = spacecraft,
          .counts = &counts_of(origin.source),
          .session = &session,
          .highest = &highest_of(session, spacecraft, origin.seq)};
}

bool SequenceTracker::has_jumped(const Session& session, std::uint64_t seq) {
  const auto& runs = session.runs;
  const std::uint64_t first = runs.empty() ? session.floor : runs.begin()->first;
  const std::uint64_t last = runs.empty() ? seq : runs.rbegin()->second;
  return (seq < first && first - seq > kFarthestJump) || (seq > last && seq - last > kFarthestJump);
}

Arrival SequenceTracker::insert(Session& session, std::uint64_t seq, SequenceCounts& counts) {
  auto& runs = session.runs;
  if (runs.empty()) {
    // A sample that was stored before is sent again; the session continues from the stored end.
    const std::uint64_t reached = seq < session.floor ? session.floor - 1 : seq;
    runs.emplace(reached, reached);
    return Arrival::New;
  }
  const auto last = std::prev(runs.end());
  if (seq > last->second) {
    if (seq - last->second == 1) {
      last->second = seq;
      return Arrival::New;
    }
    counts.missing += seq - last->second - 1;
    join_neighbours(session, runs.emplace(seq, seq).first);
    return Arrival::New;
  }
  if (seq < session.floor) {
    return Arrival::New;
  }
  const auto above = runs.upper_bound(seq);
  if (above != runs.begin() && seq <= std::prev(above)->second) {
    return Arrival::Duplicate;
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

std::uint64_t& SequenceTracker::highest_of(Session& session, const std::string& spacecraft,
                                           std::uint64_t seq) {
  auto& highest = session.highest;
  const bool room = highest.size() < kMaxSpacecraft || highest.contains(spacecraft);
  return highest.try_emplace(room ? spacecraft : std::string{}, seq).first->second;
}

SequenceTracker::Session& SequenceTracker::session_of(const Origin& origin, std::size_t topic) {
  const std::tuple key{origin.source, origin.session, topic};
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

SequenceTracker::SourceEntry& SequenceTracker::counts_of(const std::string& source) {
  const bool room = by_source_.size() < kMaxSources || by_source_.contains(source);
  return *by_source_.try_emplace(room ? source : kOtherSources).first;
}

}  // namespace spindrift
