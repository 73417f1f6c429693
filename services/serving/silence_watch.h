/// @file
/// When streams fall silent, by the wall clock.

#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

/// Of the spacecraft that were heard since the service started: what a restart has read back waits
/// until its senders had a chance to send again. Times are given, so that it knows no clock.
class SilenceWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kSilence{1};

  void note(const std::string& spacecraft, Instant now) { last_.insert_or_assign(spacecraft, now); }

  /// When the next falls silent, if nothing comes. Empty: none is heard.
  std::optional<Instant> next() const;

  /// Those that are silent by `now`, each once until it is heard again.
  std::vector<std::string> take_silent(Instant now);

 private:
  std::map<std::string, Instant> last_;  ///< When the last sample came.
};

}  // namespace spindrift
