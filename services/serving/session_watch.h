/// @file
/// Tracks the sources of telemetry: the sessions they begin, what they repeat, and what is missing.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "pipelines/supervision/service_conditions.h"
#include "services/archive/records.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/sequence_counts.h"

namespace spindrift {

/// Tracks the sessions of every source. A sample of a new session from before its beginning was
/// sent before. May be used by any thread. Memory is bounded: at most kMostSources sources of a
/// spacecraft and kMostSessions sessions of a source are tracked.
class SessionWatch {
 public:
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::size_t kMostSessions = 256;

  /// Restores, after a restart, the sessions that have begun and the time `newest` that the
  /// telemetry of the spacecraft had reached.
  void go_on(const std::string& spacecraft, const LastOrigins& origins,
             std::optional<TaiTime> newest);

  void follow(const ArchiveBatch& batch);

  /// Returns the record of each source of a spacecraft. @param missing Missing samples by source,
  /// over all spacecraft: it is unknown which of the source's spacecraft they belong to.
  std::map<std::string, SourceRecord> report(
      const std::string& spacecraft, const std::map<std::string, std::uint64_t>& missing) const;

  std::uint64_t samples() const;

 private:
  struct Source {
    std::set<std::uint64_t> sessions;
    /// Session that was heard last; empty when none was since the start.
    std::optional<std::uint64_t> session;
    std::optional<TaiTime> before;  ///< Newest time when a session that began here began.
    SourceRecord record;
  };
  struct Spacecraft {
    std::optional<TaiTime> newest;
    std::map<std::string, Source> sources;
  };

  static Source* source_of(Spacecraft& spacecraft, const Origin& origin);

  mutable std::mutex mutex_;
  std::map<std::string, Spacecraft> spacecraft_;
  std::uint64_t samples_ = 0;
};

/// Finds gaps that last: samples that are merely under way leave gaps for a moment, too.
class GapWatch {
 public:
  /// Compares the gaps with those of the previous call. To be called at a steady rate.
  /// @return Sources that missed samples at the previous call too, with the number still missing.
  std::map<std::string, std::uint64_t> beat(const std::map<std::string, SequenceCounts>& by_source);

 private:
  std::map<std::string, std::uint64_t> before_;
};

/// Returns text such as "front-end 3, replay 1".
std::string to_text(const std::map<std::string, std::uint64_t>& gaps);

}  // namespace spindrift
