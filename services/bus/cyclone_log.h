/// @file
/// Forwards log messages of Cyclone DDS to our log.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace spindrift::bus {

/// Starts forwarding for this process, at most once a minute per source line of Cyclone: a sender
/// with an unreadable type makes it complain about every sample.
void log_what_cyclone_says();

/// Limits repeated log lines from the same place in the source.
class LogLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::minutes kPeriod{1};

  /// @param file File and, with `line`, place in the source. @return Empty when the line is to be
  ///        dropped, else the number of dropped lines since the last one passed.
  std::optional<std::uint64_t> pass(std::string_view file, std::uint32_t line, Time now);

 private:
  struct Place {
    Time said;
    std::uint64_t left_out = 0;
  };
  std::map<std::pair<std::string, std::uint32_t>, Place> places_;
};

}  // namespace spindrift::bus
