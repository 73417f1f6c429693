/// @file
/// Decides which source's time the pass of a spacecraft follows when its sources disagree.

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
  std::optional<TaiTime> host = {};  ///< Host clock; empty unless the telemetry is live.
};

/// How telemetry time relates to wall-clock time.
struct Pace {
  bool is_of_the_clock;              ///< Telemetry time goes on while a source pauses.
  std::chrono::nanoseconds silence;  ///< Wall time after which a source is silent.
  std::chrono::nanoseconds ahead;    ///< A source further ahead of the others is apart.
};
/// Pace of live telemetry. The limit `ahead` is small because a source that is ahead makes the
/// samples of all others late. Links differ by a few seconds; UTC and GPS time taken for TAI by 37
/// s and 19 s.
inline constexpr Pace kLivePace{true, std::chrono::minutes{1}, std::chrono::seconds{5}};
/// Pace of a replay, whose speed has no relation to the wall clock.
inline constexpr Pace kReplayPace{false, std::chrono::seconds{5}, kApart};

/// Judges the time of each source of a spacecraft against the other sources.
/// A sample ahead of the other sources, or more than kApart behind them, is apart: it is held and
/// not computed until it is known which source is right. A sample that is less far behind is late;
/// the pipelines handle it, and it does not move the time of the pass. The jumps ahead of a source
/// that carries the pass alone are left to PassWatch and the pipelines.
/// A source that is apart or late takes over the pass when it gave enough samples and the others
/// are silent, or when it has more votes than the pass. The sources that agree with one another
/// vote, and so does the host's clock, for the nearer of the two times. A source that is behind may
/// be sending its last minutes again: unless the host's clock votes for it, it has one silence to
/// catch up.
/// Memory is bounded: above kMostSources the source not heard for longest is forgotten, and above
/// kMostHeld the samples of the source that holds most are dropped.
class SourceWatch {
 public:
  static constexpr std::chrono::minutes kHostApart{10};
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::size_t kMostHeld = 1'000'000;

  /// Healed: the sample is in time, and earlier samples of its source are still held.
  enum class Verdict { InTime, Healed, Apart };

  explicit SourceWatch(const Pace& pace) : pace_{pace} {}

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
  TelemetryValues take_held(const Origin& origin);

  /// Returns the source whose time the pass follows from now on; empty when nothing changes.
  std::optional<SourceId> successor(const Moment& moment) const;
  /// Returns the source to follow when no more samples come: one that gave enough samples since any
  /// other source carried the pass, and holds more than `samples`.
  std::optional<SourceId> successor_at_end(std::size_t samples) const;
  /// Returns when `successor` may change its answer without a sample; empty: never.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const;
  /// Makes the pass follow this source. @return The samples held of the source.
  TelemetryValues follow(const SourceId& successor);

  std::size_t held() const { return held_; }
  /// Returns the time that the pass has reached; empty until enough samples have come.
  std::optional<TaiTime> pass_time() const { return pass_.time(); }
  /// Returns the source of the last sample in time; empty when there is none or it is forgotten.
  std::optional<SourceId> carrier() const {
    return carrier_ == nullptr ? std::nullopt : std::optional{*carrier_};
  }
  TaiTime recent(const SourceId& source) const { return sources_.at(source).time.recent(); }

  /// Reports that a source came apart from the others or agrees with them again.
  struct News {
    SourceId source;
    TaiTime t;
    TaiTime pass;
    bool healed;
  };
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  /// Returns the sources that are reported as apart, with the time each was last heard.
  std::vector<std::pair<News, std::chrono::steady_clock::time_point>> apart() const;

  /// @name To be called after a restart, in this order
  /// @{
  void restore(TaiTime in_time, const Moment& moment) {
    pass_.advance_to(in_time);
    pass_heard_ = moment.now;
  }
  /// Restores a source that gave stored samples that are in time.
  void restore_carrier(const Origin& origin, const Moment& moment);
  /// Restores a sample of a source that was apart.
  /// @param last_word Whether no sample in time was stored after it.
  template <class Value>
  void restore_apart(const Origin& origin, const Arrived<Value>& arrived, bool last_word,
                     const Moment& moment) {
    note_apart(source_of(origin, moment), arrived.value.t, last_word, moment);
    hold(arrived);
  }
  /// @}

 private:
  using Instant = std::chrono::steady_clock::time_point;

  struct Source {
    SteadyTime time;
    Instant heard;
    bool carries = false;                ///< Its last sample agreed with the others.
    std::optional<Instant> apart_since;  ///< Empty when it is not apart.
    std::size_t alone = 0;               ///< Samples apart since another source was level.
    std::uint64_t carried = 0;           ///< Value of `carried_` when `alone` began.
    bool told = false;
    TelemetryValues held;
  };
  using Entry = std::pair<const SourceId, Source>;

  /// Where a stream may be: from the time of its samples to that plus the wall time since then.
  struct Reach {
    TaiTime from;
    TaiTime to;
  };
  enum class Place { Level, Late, Apart };

  Verdict judge(const Origin& origin, TaiTime t, const Moment& moment);
  Place place_of(const Source& source, std::optional<Reach> others, TaiTime t, Instant now) const;
  void note_level(Source& source, TaiTime t, const Moment& moment);
  void note_apart(Source& source, TaiTime t, bool counts, const Moment& moment) const;
  void tell(Entry& entry, TaiTime t, std::optional<Reach> others, const Moment& moment);
  template <class Value>
  void hold(const Arrived<Value>& arrived) {
    make_room();
    last_->second.held.of<Value>().push_back(arrived);
    ++held_;
  }
  void make_room();
  Source& source_of(const Origin& origin, const Moment& moment);
  Reach reach(TaiTime t, Instant heard, Instant now) const;
  std::optional<Reach> reach_of_pass(Instant now) const;
  std::optional<Reach> reach_of_others(const Source& source, Instant now) const;
  bool agree(const Reach& one, const Reach& other) const;
  bool is_heard(const Source& source, Instant now) const;
  std::size_t supporters(const Reach& reach, Instant now) const;
  std::ptrdiff_t vote_of_host(const Reach& there, const Moment& moment) const;
  std::ptrdiff_t lead_over_pass(const Reach& there, const Moment& moment) const;
  bool has_last_word(const Source& source) const;
  bool can_follow(const Source& source, const Moment& moment) const;

  Pace pace_;
  std::map<SourceId, Source> sources_;
  Entry* last_ = nullptr;  ///< Source of the sample seen last.
  const SourceId* carrier_ = nullptr;
  SteadyTime pass_;
  Instant pass_heard_{};
  std::uint64_t carried_ = 0;  ///< Number of samples that were level.
  std::size_t held_ = 0;
  std::vector<News> news_;
};

}  // namespace spindrift
