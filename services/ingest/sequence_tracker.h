/// @file
/// Gaps, duplicates and disorder, found from `seq`: DDS does not tell of every sample it loses.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "services/ingest/sample.h"
#include "services/ingest/sequence_counts.h"

namespace spindrift {

enum class Arrival { New, Duplicate };

/// Of one topic. A late arrival fills its gap. What a session sent before the first sample seen of
/// it is no gap: it was there before we were.
///
/// A source numbers the samples of all its spacecraft together, and a reader gives them spacecraft
/// by spacecraft: gaps come and go with that, and disorder is only told within a spacecraft.
///
/// Memory is bounded. Of a session with more than kMaxRuns gaps the lowest are given up: they stay
/// counted as missing, and what still arrives there counts as new. Beyond kMaxSessions the session
/// silent for longest is forgotten; sources beyond kMaxSources are counted together, under
/// kOtherSources; the spacecraft of a session beyond kMaxSpacecraft are taken for one.
class SequenceTracker {
 public:
  /// More than the samples, and hence the gaps, that a reader can hold back.
  static constexpr std::size_t kMaxRuns = 16384;
  static constexpr std::size_t kMaxSessions = 256;
  static constexpr std::size_t kMaxSources = 256;
  static constexpr std::size_t kMaxSpacecraft = 64;
  static constexpr const char* kOtherSources = "(other sources)";

  Arrival record(const Origin& origin, const std::string& spacecraft);

  const std::map<std::string, SequenceCounts>& by_source() const { return by_source_; }

  /// The entry of `by_source` that counts the samples of `source`, of which one was recorded.
  const std::pair<const std::string, SequenceCounts>& entry_of(const std::string& source) const;

 private:
  /// What has arrived of one session: runs of consecutive seq, first to last, both included.
  struct Session {
    std::map<std::uint64_t, std::uint64_t> runs;
    std::uint64_t floor = 0;                       ///< Below it nothing is known any more.
    std::map<std::string, std::uint64_t> highest;  ///< By spacecraft.
    std::uint64_t last_active = 0;
  };

  static Arrival insert(Session& session, std::uint64_t seq, SequenceCounts& counts);
  static void join_neighbours(Session& session,
                              std::map<std::uint64_t, std::uint64_t>::iterator run);
  static bool is_overtaken(Session& session, const std::string& spacecraft, std::uint64_t seq);
  Session& session_of(const Origin& origin);
  SequenceCounts& counts_of(const std::string& source);

  std::map<std::pair<std::string, std::uint64_t>, Session> sessions_;
  std::map<std::string, SequenceCounts> by_source_;
  std::uint64_t clock_ = 0;  ///< Samples recorded.
};

}  // namespace spindrift
