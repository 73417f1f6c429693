/// @file
/// How many impossible samples are kept one by one: a sender that is wrong may be wrong for days.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/telemetry/rejected_input.h"

namespace spindrift {

/// Of each source the first in a minute, which begins with one of them. The rest of the minute is
/// one row with the last of them, its reason and their number. Sources beyond kMaxSources in a
/// minute are limited together, under kOtherSources.
///
/// Wall-clock time of arrival counts, for that of the samples may be what is impossible. A sample
/// that is sent again after a restart may therefore be kept where it was only counted, and counted
/// where it was kept: rejected input is no part of what is computed.
class RejectionLimit {
 public:
  static constexpr std::int64_t kKept = 20;
  static constexpr std::size_t kMaxSources = 256;

  /// @param now Wall clock. Empty: only its number is kept.
  std::optional<RejectedInput> pass(RejectedInput rejected, TaiTime now);

  /// Of a minute that is over by `now`, one row a source of which samples were not kept. To be
  /// asked for now and then.
  std::vector<RejectedInput> take_rest(TaiTime now);

 private:
  struct Minute {
    std::int64_t kept = 0;
    std::int64_t counted = 0;  ///< Beyond those.
    RejectedInput last = {};   ///< Of the counted.
  };

  Minute& minute_of(const std::string& source);

  TaiTime began_;
  std::map<std::string, Minute> sources_;
};

}  // namespace spindrift
