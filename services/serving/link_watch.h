/// @file
/// Tells which spacecraft are heard, since when the others are not, and which have fallen silent.

#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "services/publisher/health.h"

namespace spindrift {

/// After a kill the senders wait for the reader that was killed until Cyclone's lease of 10 s ends,
/// although some of their samples reach the new one: in order, so that their `seq` does not tell.
/// No pause is a silence that begins earlier than this after a restart.
inline constexpr std::chrono::seconds kHeldBack{15};

/// Watches all links. May be used by any thread. Times are passed in: it needs no clock.
class LinkWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// A link without a sample for longer than this is stale.
  static constexpr std::chrono::seconds kStaleAfter{5};

  explicit LinkWatch(const std::vector<std::string>& spacecraft);

  /// Notes a sample with telemetry time `t`; ignores spacecraft that are not watched.
  void hear(const std::string& spacecraft, TaiTime t, Instant now);

  /// Notes after a restart that the telemetry had reached `t`, at an unknown wall-clock time.
  void go_on(const std::string& spacecraft, TaiTime t, Instant now);

  /// Returns how long a link has been silent; empty when it has not been heard.
  std::optional<double> silent_s(const std::string& spacecraft, Instant now) const;

  std::vector<SpacecraftHealth> report(Instant now) const;

 private:
  struct Last {
    TaiTime t;
    std::optional<Instant> came;  ///< Empty for a sample from before a restart.
  };
  mutable std::mutex mutex_;
  std::map<std::string, std::optional<Last>> last_;
  std::map<std::string, Instant> counts_from_;  ///< First silence that counts, by spacecraft.
};

/// Watches the spacecraft heard since the service started: data read back after a restart waits
/// until its senders have had a chance to send again. It needs no clock.
class SilenceWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilence{1};

  /// @param counts_from Earliest beginning of a silence.
  explicit SilenceWatch(Instant counts_from = Instant::min()) : counts_from_{counts_from} {}

  void hear(const std::string& spacecraft, Instant now) {
    last_.insert_or_assign(spacecraft, std::max(now, counts_from_));
  }

  /// Returns when the next spacecraft falls silent if no sample comes; empty when none is heard.
  std::optional<Instant> next() const;

  /// Returns the spacecraft that are silent at `now`, each once until it is heard again.
  std::vector<std::string> take_silent(Instant now);

 private:
  Instant counts_from_;
  std::map<std::string, Instant> last_;  ///< Beginning of the present pause.
};

}  // namespace spindrift
