/// @file
/// How far the samples of a run reach, how much of the planned contact they cover, and where they
/// leave gaps.

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>

#include "pipelines/supervision/limits.h"
#include "pipelines/time/tai_time.h"
#include "services/archive/records.h"

namespace spindrift {

class ReachWatch {
 public:
  /// The row of a run is wide: while samples come, its end follows them by no more than this.
  static constexpr std::chrono::minutes kFollows{1};
  static constexpr std::chrono::seconds kSpan{10};
  /// No sensor is silent so long within a pass.
  static constexpr std::chrono::minutes kSilence{5};

  /// Telemetry time without a sample, all longer than kSilence.
  struct Silences {
    std::int64_t count = 0;
    TaiTime longest_from = {};
    TaiTime longest_to = {};
  };

  explicit ReachWatch(std::optional<Contact> contact) : contact_{contact} {}

  /// A sample of the run.
  void note(TaiTime t);
  /// The pass has come to `t` with it, see PassWatch: a time that is wrong does not bring it there.
  void carry_on(TaiTime t);

  /// What the archive should know now; empty: it knows.
  std::optional<RunReach> take_news();
  /// Likewise, of a run that ends.
  std::optional<RunReach> take_last();
  const Silences& silences() const { return silences_; }

 private:
  RunReach reach() const;

  std::optional<Contact> contact_;
  std::optional<TaiTime> first_;  ///< Empty: no sample yet.
  std::optional<TaiTime> last_;   ///< To which the pass has come.
  std::set<std::int64_t> spans_;  ///< Of the contact, from 0, in which samples came.
  Silences silences_;
  std::optional<RunReach> stored_;
};

}  // namespace spindrift
