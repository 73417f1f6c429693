/// @file
/// Whose time the pass of a spacecraft goes by, when its senders disagree.

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

/// When samples are looked at. Given, so that who looks knows no clock.
struct Moment {
  std::chrono::steady_clock::time_point now = {};
  std::optional<TaiTime> host = {};  ///< Where samples are of now, what the host takes for now.
};

/// How the time of telemetry goes.
struct Pace {
  bool is_of_the_clock;              ///< As on the wall: while a source pauses, its time goes on.
  std::chrono::nanoseconds silence;  ///< After so long on the wall a source is silent.
  std::chrono::nanoseconds ahead;    ///< Further ahead of the others one is apart.
};
/// A source that is ahead makes the samples of all others late. Links differ by a few seconds; UTC
/// and the time of GPS taken for TAI are 37 and 19 s off.
inline constexpr Pace kLivePace{true, std::chrono::minutes{1}, std::chrono::seconds{5}};
/// A replay is as fast as it likes.
inline constexpr Pace kReplayPace{false, std::chrono::seconds{5}, kApart};

/// A sample ahead of the other sources, or more than kApart behind them, is apart: it does not
/// count, and is held until it is known who is right. One that is less behind is late, which the
/// pipelines see to, and has no say. Only the jumps ahead of a source that carries the pass alone
/// are left to PassWatch and the pipelines.
///
/// A source that is apart or late carries the pass on when it gave enough and the others are
/// silent, or when it has more votes than the pass: those of the sources that agree, and that of
/// the host's clock, which goes to the nearer. One behind, which may be sending its last minutes
/// again, has as long as a silence to catch up, if not the host is for it.
///
/// Memory is bounded: beyond kMostSources the one not heard for longest is forgotten, and beyond
/// kMostHeld samples those of the source that has most.
class SourceWatch {
 public:
  static constexpr std::chrono::minutes kHostApart{10};
  static constexpr std::size_t kMostSources = 64;
  static constexpr std::size_t kMostHeld = 1'000'000;

  /// Healed: in time again, and some of the source are held.
  enum class Verdict { InTime, Healed, Apart };

  explicit SourceWatch(const Pace& pace) : pace_{pace} {}

  template <class Value>
  Verdict see(const Origin& origin, const Arrived<Value>& arrived, const Moment& moment) {
    const Verdict verdict = judge(origin, arrived.value.t, moment);
    if (verdict == Verdict::Apart) {
      hold(arrived);
    }
    return verdict;
  }

  /// It sent something again, which tells nothing of its time.
  void hear(const Origin& origin, const Moment& moment);

  /// Of one that has healed: what was only late. What is from ahead stays left out.
  TelemetryValues take_held(const Origin& origin);

  /// The source that carries the pass on from now on, if another than before.
  std::optional<SourceId> successor(const Moment& moment) const;
  /// The same when nothing more comes: the one that gave enough since the others, and more than
  /// `samples`.
  std::optional<SourceId> successor_at_end(std::size_t samples) const;
  /// Where `successor` may have one, though nothing comes.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const;
  /// @return What is held of it.
  TelemetryValues follow(const SourceId& successor);

  std::size_t held() const { return held_; }
  /// How far the pass has come; empty: nobody can tell yet.
  std::optional<TaiTime> pass_time() const { return pass_.time(); }
  /// Whose sample was in time last; empty: none yet, or it is forgotten.
  std::optional<SourceId> carrier() const {
    return carrier_ == nullptr ? std::nullopt : std::optional{*carrier_};
  }
  TaiTime recent(const SourceId& source) const { return sources_.at(source).time.recent(); }

  /// A source that is apart from the others, or no longer.
  struct News {
    SourceId source;
    TaiTime t;
    TaiTime pass;
    bool healed;
  };
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  /// Those of the news that are not healed, with when they were heard last.
  std::vector<std::pair<News, std::chrono::steady_clock::time_point>> apart() const;

  /// @name After a restart, in this order
  /// @{
  void restore(TaiTime in_time, const Moment& moment) {
    pass_.see(in_time);
    pass_heard_ = moment.now;
  }
  /// It gave some of what is in time.
  void restore_carrier(const Origin& origin, const Moment& moment);
  /// @param last_word Nothing in time came since.
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
    bool carries = false;                ///< Its last sample was level with the others.
    std::optional<Instant> apart_since;  ///< Empty: it is not.
    std::size_t alone = 0;               ///< Apart, since the last level one of another.
    std::uint64_t carried = 0;           ///< How many were level then.
    bool told = false;
    TelemetryValues held;
  };
  using Entry = std::pair<const SourceId, Source>;

  /// Where a stream is: from where its samples have come to where it may be by now.
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
  Entry* last_ = nullptr;  ///< Whose sample was seen last.
  const SourceId* carrier_ = nullptr;
  SteadyTime pass_;
  Instant pass_heard_{};
  std::uint64_t carried_ = 0;  ///< Samples that were level.
  std::size_t held_ = 0;
  std::vector<News> news_;
};

}  // namespace spindrift
