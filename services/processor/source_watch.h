/// @file
/// Decides which sources of a spacecraft are in time, and whose telemetry its pass follows.

#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/processor/steady_time.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

struct SourceId {
  std::string name;
  std::uint64_t session = 0;
  friend auto operator<=>(const SourceId&, const SourceId&) = default;
};

/// The moment at which samples are judged. It is passed in so that the judging code needs no clock.
struct Moment {
  std::chrono::steady_clock::time_point now = {};
  std::optional<TaiTime> host = {};  ///< The host's clock; empty in a replay.
  /// Clocks that rehearsals tell, by spacecraft.
  std::map<std::string, TaiTime> rehearsed = {};

  /// Returns the moment for a spacecraft, whose clock is `host` then.
  Moment of(const std::string& spacecraft) const {
    const auto told = rehearsed.find(spacecraft);
    return {.now = now, .host = told == rehearsed.end() ? host : std::optional{told->second}};
  }
};

struct SourceLimits {
  std::chrono::nanoseconds within;   ///< A sample further from the clock is apart.
  std::chrono::nanoseconds silence;  ///< Wall time after which a source is silent.
};
/// Limits without a clock, for a replay of any speed.
inline constexpr SourceLimits kReplayLimits{std::chrono::minutes{10}, std::chrono::seconds{5}};

/// Judges the time of each source of a spacecraft. A source is in time while its samples lie within
/// a limit of the clock. Where no source is in time by the host's clock, or there is none, the
/// first source leads: its own telemetry is the clock, until it is silent or another source is in
/// time by the host.
///
/// Samples of a source that is apart are held and not computed until it is in time again, or leads.
/// What a source sends again of its last minutes is late, which is for the pipelines to handle.
/// Memory is bounded: above kMostSources the source not heard for longest is forgotten, and above
/// kMostHeld the samples of the source that holds most are dropped.
class SourceWatch {
 public:
  /// A source may send as much telemetry again, for as long as a silence lasts.
  static constexpr std::chrono::minutes kSentAgain{10};
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::size_t kMostHeld = 1'000'000;

  /// Healed: the sample is in time, and earlier samples of its source are still held.
  enum class Verdict { InTime, Healed, Apart };

  /// @param by_clock Limits from the first moment with a host's clock on.
  explicit SourceWatch(const SourceLimits& by_clock, const SourceLimits& until_then = kReplayLimits)
      : by_clock_{by_clock}, limits_{until_then} {}

  template <class Value>
  Verdict admit(const Origin& origin, const Arrived<Value>& arrived, const Moment& moment) {
    const Verdict verdict = judge(origin, arrived.value.t, moment);
    if (verdict == Verdict::Apart) {
      hold(arrived);
    }
    return verdict;
  }

  /// Notes that the source is alive: it repeated a sample, which says nothing of its time.
  void hear(const Origin& origin, const Moment& moment);

  /// Returns the held samples of a healed source; drops those from ahead of the pass.
  TelemetryValues take_held(const SourceId& source);

  /// Returns the source that the pass follows from now on; empty when nothing changes.
  std::optional<SourceId> successor(const Moment& moment) const;
  /// Returns a source that still holds samples though the pass has come to its time meanwhile, if
  /// the host's clock has nothing against it.
  std::optional<SourceId> caught_up_with() const;
  /// Returns the source to follow when no more samples come: the last to speak, if the host's clock
  /// has nothing against it and it holds more than `samples`.
  std::optional<SourceId> successor_at_end(std::size_t samples) const;
  /// Returns when `successor` may change its answer without a sample; empty: never.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const;
  /// Makes the pass follow this source. @return The samples held of the source.
  TelemetryValues follow(const SourceId& successor, const Moment& moment);

  std::size_t held() const { return held_; }
  /// Returns the time that the pass has reached; empty until enough samples have come.
  std::optional<TaiTime> pass_time() const { return pass_.time(); }
  /// Returns the source whose telemetry is the clock; empty while the host's is.
  const std::optional<SourceId>& leader() const { return leader_; }
  TaiTime recent(const SourceId& source) const { return sources_.at(source).time.recent(); }

  /// Reports that a source came apart from the clock or is in time again.
  struct News {
    SourceId source;
    TaiTime t;
    TaiTime clock;
    bool healed;
  };
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  /// Returns the sources that are reported as apart, with the time each was last heard.
  std::vector<std::pair<News, std::chrono::steady_clock::time_point>> apart() const;

  /// @name To be called after a restart, in this order
  /// @{
  void restore(TaiTime in_time) { pass_.advance_to(in_time); }
  /// Restores a source that gave stored samples that are in time.
  void restore_in_time(const Origin& origin, const Moment& moment);
  void restore_leader(const Origin& origin, const Moment& moment) {
    source_of(origin, moment);
    leader_ = last_->first;
  }
  /// Restores a sample of a source that was apart.
  /// @param last_word Whether no sample in time was stored after it.
  template <class Value>
  void restore_apart(const Origin& origin, const Arrived<Value>& arrived, bool last_word,
                     const Moment& moment) {
    note_apart(source_of(origin, moment), arrived.value.t, last_word, moment.now);
    hold(arrived);
  }
  /// @}

 private:
  using Instant = std::chrono::steady_clock::time_point;

  struct Source {
    SteadyTime time;
    Instant heard;
    Instant since;                       ///< When it was last in time or began to send.
    bool is_in_time = false;             ///< Its last sample was in time.
    std::optional<Instant> apart_since;  ///< Empty when it is not apart.
    std::size_t alone = 0;               ///< Samples apart since another source was in time.
    std::uint64_t in_time = 0;           ///< Value of `in_time_` when `alone` began.
    std::optional<TaiTime> told;         ///< The clock when it was reported as apart.
    TelemetryValues held;
  };
  using Entry = std::pair<const SourceId, Source>;

  Verdict judge(const Origin& origin, TaiTime t, const Moment& moment);
  std::optional<TaiTime> clock(const Moment& moment) const;
  void note_in_time(TaiTime t, Instant now);
  void note_apart(Source& source, TaiTime t, bool counts, Instant now) const;
  void tell(TaiTime t, TaiTime clock, Instant now);
  template <class Value>
  void hold(const Arrived<Value>& arrived) {
    make_room();
    last_->second.held.of<Value>().push_back(arrived);
    ++held_;
  }
  void make_room();
  Source& source_of(const Origin& origin, const Moment& moment);
  bool is_near(TaiTime t, std::optional<TaiTime> clock) const;
  bool has_last_word(const Source& source) const;
  std::optional<Instant> last_in_time() const;

  SourceLimits by_clock_;
  SourceLimits limits_;
  std::map<SourceId, Source> sources_;
  Entry* last_ = nullptr;  ///< Source of the sample seen last.
  std::optional<SourceId> leader_;
  SteadyTime pass_;
  std::uint64_t in_time_ = 0;  ///< Number of samples that were in time.
  std::size_t held_ = 0;
  std::vector<News> news_;
};

}  // namespace spindrift
