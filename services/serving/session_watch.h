/// @file
/// Which sessions the sources of telemetry have begun, and what those bring again.

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
#include "services/telemetry/last_origins.h"

namespace spindrift {

/// Used by any thread. What a session brings from before it began has been sent before. Memory is
/// bounded: of a spacecraft more than kMostSources are not looked at, nor more than kMostSessions
/// of a source.
class SessionWatch {
 public:
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::size_t kMostSessions = 256;

  /// After a restart: these sessions have begun, and the telemetry of the spacecraft had come to
  /// `newest`.
  void go_on(const std::string& spacecraft, const LastOrigins& origins,
             std::optional<TaiTime> newest);

  /// The samples of `batch`, in their order.
  void note(const ArchiveBatch& batch);

  /// Of a spacecraft, by source.
  /// @param missing By source, of all spacecraft: nobody can say of which of those that it brings.
  std::map<std::string, SourceRecord> report(
      const std::string& spacecraft, const std::map<std::string, std::uint64_t>& missing) const;

  /// All that were noted.
  std::uint64_t samples() const;

 private:
  struct Source {
    std::set<std::uint64_t> sessions;
    std::optional<std::uint64_t> session;  ///< The one that was heard last; empty: none since.
    std::optional<TaiTime> before;         ///< The newest sample when it began, if it began here.
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
