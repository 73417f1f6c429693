/// @file
/// Gaps, duplicates and disorder, found from `seq`: DDS does not tell of every sample it loses.

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

/// `seq` counts per source, session and topic; the counts of a source are those of all its topics
/// together. A late arrival fills its gap. What a session sent before the first sample seen of
/// it is no gap: it was there before we were.
///
/// A source numbers the samples of all its spacecraft together, and a reader gives them spacecraft
/// by spacecraft: gaps come and go with that, and disorder is only told within a spacecraft.
///
/// A jump by more than kFarthestJump is a new session in all but name: how many samples it passes
/// over nobody can say, and it counts as one that is missing.
///
/// Memory is bounded. Of a session with more than kMaxRuns gaps the lowest are given up: they stay
/// counted as missing, and what still arrives there counts as new. Beyond kMaxSessions the session
/// silent for longest is forgotten; sources beyond kMaxSources are counted together, under
/// kOtherSources; the spacecraft of a session beyond kMaxSpacecraft are taken for one.
class SequenceTracker {
 public:
  /// More than the samples, and hence the gaps, that a reader can hold back.
  static constexpr std::size_t kMaxRuns = 16384;
  /// More than a source sends in days.
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

  /// The archive holds what a session sent up to `last`, and its gaps are counted: what of that is
  /// sent again leaves none. What follows, if it is sent again, goes on from there.
  void go_on(const Origin& last, std::size_t topic = 0);

  /// @param topic  Any number that stands for the topic.
  Arrival record(const Origin& origin, const std::string& spacecraft, std::size_t topic = 0);

  const std::map<std::string, SequenceCounts>& by_source() const { return by_source_; }

  /// Those entries of `by_source` in which samples were recorded since this was last asked.
  std::map<std::string, SequenceCounts> take_changed();

 private:
  /// What has arrived of one session: runs of consecutive seq, first to last, both included.
  struct Session {
    std::map<std::uint64_t, std::uint64_t> runs;
    std::uint64_t floor = 0;                       ///< Below it gaps are not looked for any more.
    std::map<std::string, std::uint64_t> highest;  ///< By spacecraft.
    std::uint64_t last_active = 0;
  };

  using SourceEntry = std::pair<const std::string, SequenceCounts>;

  /// Where the samples of one source, session, topic and spacecraft are recorded.
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
  Place last_;               ///< Where the next sample most often belongs as well.
  std::uint64_t clock_ = 0;  ///< Samples recorded.
};

}  // namespace spindrift
