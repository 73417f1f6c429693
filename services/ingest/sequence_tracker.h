/// @file
/// Finds gaps, duplicates and disorder from `seq`, because DDS does not report every lost sample.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "services/telemetry/sequence_counts.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

enum class Arrival { New, Duplicate };

/// Tracks `seq` per source, session and topic; the counts of a source are summed over its topics. A
/// late arrival fills its gap. Samples that a session sent before the first one received are no
/// gap, because they were sent before this reader existed. A source numbers the samples of all its
/// spacecraft together, whereas a reader delivers them spacecraft by spacecraft. So gaps come and
/// go, and disorder is counted per spacecraft. A jump by more than kFarthestJump is treated like a
/// new session: the number of samples in between is unknown and counts as one missing sample.
/// Memory is bounded. In a session with more than kMaxRuns gaps the lowest are given up: they stay
/// counted as missing, and samples that still arrive there count as new. Beyond kMaxSessions the
/// session silent for longest is forgotten. Sources beyond kMaxSources are counted together under
/// kOtherSources, and the spacecraft of a session beyond kMaxSpacecraft are treated as one.
class SequenceTracker {
 public:
  /// More than the number of samples, and hence of gaps, that a reader can hold back.
  static constexpr std::size_t kMaxRuns = 16384;
  /// More samples than a source sends in days.
  static constexpr std::uint64_t kFarthestJump = 10'000'000;
  static constexpr std::size_t kMaxSessions = 256;
  static constexpr std::size_t kMaxSources = 256;
  static constexpr std::size_t kMaxSpacecraft = 64;
  static constexpr const char* kOtherSources = "(other sources)";

  SequenceTracker() = default;
  ~SequenceTracker() = default;
  SequenceTracker(const SequenceTracker&) = delete;
  SequenceTracker& operator=(const SequenceTracker&) = delete;
  SequenceTracker(SequenceTracker&&) = delete;
  SequenceTracker& operator=(SequenceTracker&&) = delete;

  /// Restores a session whose samples up to `last` are stored, with their gaps counted. Samples up
  /// to `last` that are sent again leave no new gaps, and later samples continue from there.
  void go_on(const Origin& last, std::size_t topic = 0);

  /// @param topic Any number that identifies the topic.
  Arrival record(const Origin& origin, const std::string& spacecraft, std::size_t topic = 0);

  const std::map<std::string, SequenceCounts>& by_source() const { return by_source_; }

  /// Returns the entries of `by_source` with samples recorded since the last call.
  std::map<std::string, SequenceCounts> take_changed();

 private:
  /// What arrived in one session, as runs of consecutive seq: first to last, both included.
  struct Session {
    std::map<std::uint64_t, std::uint64_t> runs;
    std::uint64_t floor = 0;                       ///< Below this seq gaps are no longer tracked.
    std::map<std::string, std::uint64_t> highest;  ///< Highest seq by spacecraft.
    std::uint64_t last_active = 0;
  };

  using SourceEntry = std::pair<const std::string, SequenceCounts>;

  /// The counters for the samples of one source, session, topic and spacecraft.
  struct Place {
    std::string source;
    std::uint64_t session_number = 0;
    std::size_t topic = 0;
    std::string spacecraft;
    SourceEntry* counts = nullptr;
    Session* session = nullptr;
    std::uint64_t* highest = nullptr;

    bool is_of(const Origin& origin, const std::string& of_spacecraft, std::size_t of_topic) const {
      return session != nullptr && session_number == origin.session && topic == of_topic &&
             source == origin.source && spacecraft == of_spacecraft;
    }
  };

  Place place_of(const Origin& origin, const std::string& spacecraft, std::size_t topic);
  static bool has_jumped(const Session& session, std::uint64_t seq);
  static Arrival insert(Session& session, std::uint64_t seq, SequenceCounts& counts);
  static void join_neighbours(Session& session,
                              std::map<std::uint64_t, std::uint64_t>::iterator run);
  static std::uint64_t& highest_of(Session& session, const std::string& spacecraft,
                                   std::uint64_t seq);
  Session& session_of(const Origin& origin, std::size_t topic);
  SourceEntry& counts_of(const std::string& source);

  std::map<std::tuple<std::string, std::uint64_t, std::size_t>, Session> sessions_;
  std::map<std::string, SequenceCounts> by_source_;
  std::set<const SourceEntry*> changed_;
  Place last_;               ///< Cached because the next sample mostly has the same place.
  std::uint64_t clock_ = 0;  ///< Number of samples recorded.
};

}  // namespace spindrift
