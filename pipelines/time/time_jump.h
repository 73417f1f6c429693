/// @file
/// Decides whether the time of a stream has jumped ahead or some time stamps are stray.
///
/// A clock may be wrong for 20 s in a row, and as long do the first products wait after a silence
/// of a minute. Eight samples in a row as the only criterion were rejected, because a glitch of one
/// second makes as many; a minute was rejected, because an operator would wait for it in vain.
///
/// Not recognised: a clock that is wrong for longer while nobody else sends, and one that is ahead
/// by more than a second from the first sample on. Stray samples at the end of all telemetry are
/// taken for a second contact, unless they are of one kind among several.

#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// Examines samples in order of arrival. The number of samples ahead proves nothing, because a
/// sender with a bad clock can send any number. Time has jumped if no sample continues the former
/// time any more and samples from ahead follow one another for kGoesOn. If there are several kinds,
/// one kind alone cannot move the time, because its clock may be wrong.
class TimeJump {
 public:
  /// Largest distance of two samples that follow one another.
  static constexpr std::chrono::nanoseconds kFar{std::chrono::minutes{1}};
  /// Span of its own time for which a wrong clock moves nothing.
  static constexpr std::chrono::nanoseconds kGoesOn{std::chrono::seconds{20}};
  /// Fewer samples prove nothing.
  static constexpr std::size_t kFewest = 8;

  /// Adds a sample that continues the former time, which invalidates all samples ahead so far.
  /// @param kind Below 64.
  void hear(std::size_t kind) {
    register_kind(kind);
    ahead_ = {};
  }
  /// Registers a kind without continuing the former time.
  void register_kind(std::size_t kind) { heard_ |= bit_of(kind); }

  /// Adds a sample from ahead.
  void add_ahead(TaiTime t, std::size_t kind) {
    if (!holds(t)) {
      ahead_ = {.first = t, .last = t};
    }
    ahead_.first = std::min(ahead_.first, t);
    ahead_.last = std::max(ahead_.last, t);
    ahead_.kinds |= bit_of(kind);
    ++ahead_.samples;
  }

  /// Returns whether `t` is near the run of samples from ahead.
  bool holds(TaiTime t) const {
    return ahead_.samples > 0 && span_between(ahead_.last, t) <= kFar &&
           span_between(t, ahead_.first) <= kFar;
  }

  bool has_shown() const {
    return could_be() && span_between(ahead_.first, ahead_.last) >= kGoesOn;
  }
  /// Returns whether a jump is possible; sufficient once no further samples can contradict it.
  bool could_be() const { return is_enough(ahead_.samples, ahead_.kinds); }

  /// Returns whether samples of these kinds (bits) can form a stream by themselves.
  bool is_enough(std::size_t samples, std::uint64_t kinds) const {
    return samples >= kFewest && !(std::has_single_bit(kinds) && (heard_ & ~kinds) != 0);
  }

  /// Accepts the jump: samples from ahead now continue the time.
  void accept() {
    heard_ |= ahead_.kinds;
    ahead_ = {};
  }

  static constexpr std::uint64_t bit_of(std::size_t kind) { return std::uint64_t{1} << kind; }

 private:
  struct Ahead {
    TaiTime first{};
    TaiTime last{};
    std::size_t samples = 0;
    std::uint64_t kinds = 0;
  };

  std::uint64_t heard_ = 0;  ///< Kinds of samples in time, as bits.
  Ahead ahead_;              ///< Run of samples ahead, with none in time between them.
};

}  // namespace spindrift
