/// @file
/// Detects by the wall clock when streams fall silent.

#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

/// Watches the spacecraft heard since the service started: data read back after a restart waits
/// until its senders have had a chance to send again. It needs no clock.
class SilenceWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilence{1};

  void note(const std::string& spacecraft, Instant now) { last_.insert_or_assign(spacecraft, now); }

  /// Returns when the next spacecraft falls silent if no sample comes; empty when none is heard.
  std::optional<Instant> next() const;

  /// Returns the spacecraft that are silent at `now`, each once until it is heard again.
  std::vector<std::string> take_silent(Instant now);

 private:
  std::map<std::string, Instant> last_;  ///< Arrival time of the last sample.
};

}  // namespace spindrift
