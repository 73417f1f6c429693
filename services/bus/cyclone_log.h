/// @file
/// What Cyclone DDS says of itself, in our log.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace spindrift::bus {

/// From now on, for this process: every place of Cyclone that complains is heard once a minute,
/// since a sender whose type it cannot read makes it say so for every sample.
void log_what_cyclone_says();

/// Which of many lines from the same places are said.
class LogLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::minutes kPeriod{1};

  /// @param place In whatever writes them: file and line. @return how many lines of it were left
  /// out since the one said last; empty: this one is.
  std::optional<std::uint64_t> pass(std::string_view file, std::uint32_t line, Time now);

 private:
  struct Place {
    Time said;
    std::uint64_t left_out = 0;
  };
  std::map<std::pair<std::string, std::uint32_t>, Place> places_;
};

}  // namespace spindrift::bus
