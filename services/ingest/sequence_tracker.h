/// @file
/// Gaps, duplicates and disorder, found from `seq`: DDS does not tell of every sample it loses.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "services/ingest/sample.h"

namespace spindrift {

struct SequenceCounts {
  std::uint64_t received = 0;  ///< All that arrived, duplicates too.
  std::uint64_t missing = 0;   ///< Gaps: between the lowest and highest seq of a session, not here.
  std::uint64_t duplicates = 0;  ///< Arrived before, same session and seq.
  std::uint64_t disordered = 0;  ///< Arrived after a higher seq of its session.

  SequenceCounts& operator+=(const SequenceCounts& other);
  friend bool operator==(const SequenceCounts&, const SequenceCounts&) = default;
};

enum class Arrival { New, Duplicate };

/// Of one topic. A late arrival fills its gap. What a session sent before the first sample seen of
/// it is no gap: it was there before we were.
///
/// Memory is bounded. Of a session with more than kMaxRuns gaps the lowest are given up: they stay
/// counted as missing, and what still arrives there counts as new. Beyond kMaxSessions the session
/// silent for longest is forgotten; sources beyond kMaxSources are counted together, under
/// kOtherSources.
class SequenceTracker {
 public:
  static constexpr std::size_t kMaxRuns = 4096;
  static constexpr std::size_t kMaxSessions = 256;
  static constexpr std::size_t kMaxSources = 256;
  static constexpr const char* kOtherSources = "(other sources)";

  Arrival record(const Origin& origin);

  const std::map<std::string, SequenceCounts>& by_source() const { return by_source_; }

 private:
  /// What has arrived of one session: runs of consecutive seq, first to last, both included.
  struct Session {
    std::map<std::uint64_t, std::uint64_t> runs;
    std::uint64_t floor = 0;  ///< Below it nothing is known any more.
    std::uint64_t last_active = 0;
  };

  static Arrival insert(Session& session, std::uint64_t seq, SequenceCounts& counts);
  static void join_neighbours(Session& session,
                              std::map<std::uint64_t, std::uint64_t>::iterator run);
  Session& session_of(const Origin& origin);
  SequenceCounts& counts_of(const std::string& source);

  std::map<std::pair<std::string, std::uint64_t>, Session> sessions_;
  std::map<std::string, SequenceCounts> by_source_;
  std::uint64_t clock_ = 0;  ///< Samples recorded.
};

}  // namespace spindrift
