/// @file
/// Tracks the sessions that the sources of telemetry begin, and the samples that they repeat.

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

  void note(const ArchiveBatch& batch);

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

}  // namespace spindrift
