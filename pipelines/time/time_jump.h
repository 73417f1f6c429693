/// @file
/// Whether the time of a stream has jumped ahead, or some of its stamps are stray.

#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

/// Looks at samples in the order of their arrival. How many are ahead says nothing, since a sender
/// with a bad clock stamps as many as it likes. Time has jumped when the stream goes on from there:
/// nothing carries the time before it on any more, and samples that follow one another do so
/// for kGoesOn. One kind alone moves no time where there are several, since the clock that stamps
/// it may be wrong.
class TimeJump {
 public:
  /// Further apart two samples do not follow one another.
  static constexpr std::chrono::nanoseconds kFar{std::chrono::minutes{1}};
  /// A clock that is wrong for less than this of its own time moves nothing.
  static constexpr std::chrono::nanoseconds kGoesOn{std::chrono::seconds{20}};
  /// Fewer samples show nothing at all.
  static constexpr std::size_t kFewest = 8;

  /// A sample that carries time on: what came from ahead so far has not moved it.
  /// @param kind Below 64.
  void hear(std::size_t kind) {
    note(kind);
    ahead_ = {};
  }
  /// One that says nothing of that.
  void note(std::size_t kind) { heard_ |= bit_of(kind); }

  /// A sample from ahead.
  void see(TaiTime t, std::size_t kind) {
    if (!holds(t)) {
      ahead_ = {.first = t, .last = t};
    }
    ahead_.first = std::min(ahead_.first, t);
    ahead_.last = std::max(ahead_.last, t);
    ahead_.kinds |= bit_of(kind);
    ++ahead_.samples;
  }

  /// Whether `t` follows, or is followed by, those from ahead that came in a row.
  bool holds(TaiTime t) const {
    return ahead_.samples > 0 && span_between(ahead_.last, t) <= kFar &&
           span_between(t, ahead_.first) <= kFar;
  }

  bool has_shown() const {
    return could_be() && span_between(ahead_.first, ahead_.last) >= kGoesOn;
  }
  /// Where nothing comes any more that could speak against it.
  bool could_be() const { return is_enough(ahead_.samples, ahead_.kinds); }

  /// Whether so many samples of these kinds, as bits, can be a stream by themselves.
  bool is_enough(std::size_t samples, std::uint64_t kinds) const {
    return samples >= kFewest && !(std::has_single_bit(kinds) && (heard_ & ~kinds) != 0);
  }

  /// The jump is accepted: those ahead are in time.
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

  std::uint64_t heard_ = 0;  ///< Kinds of samples in time.
  Ahead ahead_;              ///< That follow one another, with none in time between them.
};

}  // namespace spindrift
