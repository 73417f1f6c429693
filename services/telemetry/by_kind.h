/// @file
/// Containers with an element for each kind of telemetry.

#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "pipelines/time/tai_time.h"
#include "services/telemetry/places.h"
#include "services/telemetry/telemetry_kinds.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

inline constexpr std::size_t kTelemetryKindCount = TelemetryKinds::kSize;

/// A kind of telemetry as a value.
using TelemetryKind = TelemetryKinds::Of<std::variant, Kind>;

template <class Value>
inline constexpr std::size_t kTelemetryKind = TelemetryKinds::index_of<Value>();

inline std::string_view name_of(const TelemetryKind& kind) {
  return std::visit([]<class Value>(Kind<Value>) { return Telemetry<Value>::kName; }, kind);
}

/// Holds a `Content<Value>` for each kind.
template <template <class> class Content>
class ByKind {
 public:
  template <class Value>
  Content<Value>& of() {
    return std::get<kTelemetryKind<Value>>(all_);
  }
  template <class Value>
  const Content<Value>& of() const {
    return std::get<kTelemetryKind<Value>>(all_);
  }

  /// Calls `see` with the content of each kind, in the order of TelemetryKinds.
  template <class See>
  void for_each(See&& see) {
    std::apply([&](auto&... content) { (see(content), ...); }, all_);
  }
  template <class See>
  void for_each(See&& see) const {
    std::apply([&](const auto&... content) { (see(content), ...); }, all_);
  }

 private:
  TelemetryKinds::Of<std::tuple, Content> all_;
};

template <class Value>
using SamplesOfKind = std::vector<TelemetrySample<Value>>;

using TelemetrySamples = ByKind<SamplesOfKind>;

template <class Value>
using ArrivedSamplesOfKind = std::vector<ArrivedSample<Value>>;
using ArrivedSamples = ByKind<ArrivedSamplesOfKind>;

/// A value with its place in the order of arrival, without its origin.
template <class Value>
struct Arrived {
  RunPlace arrival;
  Value value;
};
template <class Value>
using ArrivedOfKind = std::vector<Arrived<Value>>;
using TelemetryValues = ByKind<ArrivedOfKind>;

/// A value with its place in a batch of values.
template <class Value>
struct Placed {
  BatchPlace place;
  Value value;
};
template <class Value>
using PlacedOfKind = std::vector<Placed<Value>>;
using PlacedValues = ByKind<PlacedOfKind>;

/// Returns the place by which `in_order_of_arrival` orders an element.
template <class Element>
constexpr auto place_of(const Element& element) {
  if constexpr (requires { element.place; }) {
    return element.place;
  } else {
    return element.arrival;
  }
}

/// @name Whether the run that took an element leaves it out
/// @{
template <class Value>
constexpr bool is_left_out(const ArrivedSample<Value>& sample) {
  return sample.is_left_out;
}
template <class Value>
constexpr bool is_left_out(const Arrived<Value>& /*in_time*/) {
  return false;
}
template <class Value>
constexpr bool is_left_out(const Placed<Value>& /*in_time*/) {
  return false;
}
/// @}

/// Counts the elements of all kinds.
template <template <class> class Content>
std::size_t count_of(const ByKind<Content>& all) {
  std::size_t count = 0;
  all.for_each([&count](const auto& of_kind) { count += of_kind.size(); });
  return count;
}

/// Calls `see` with each element of all kinds in the order of their places. Each kind must be in
/// that order already.
template <class All, class See>
void in_order_of_arrival(All&& all, See&& see) {
  using Place = decltype(place_of(all.template of<Pulse>().front()));
  constexpr Place kNone{std::numeric_limits<std::int64_t>::max()};
  std::array<std::size_t, kTelemetryKindCount> next{};
  while (true) {
    // Find the kind with the earliest next element, and when the next one of another kind comes.
    std::size_t earliest = 0;
    Place first = kNone;
    Place other = kNone;
    std::size_t kind = 0;
    all.for_each([&](const auto& of_kind) {
      const Place place = next[kind] < of_kind.size() ? place_of(of_kind[next[kind]]) : kNone;
      other = std::min(other, std::max(first, place));
      if (place < first) {
        first = place;
        earliest = kind;
      }
      ++kind;
    });
    if (first == kNone) {
      return;
    }
    kind = 0;
    all.for_each([&](auto& of_kind) {
      if (kind++ == earliest) {
        std::size_t& i = next[earliest];
        for (; i < of_kind.size() && place_of(of_kind[i]) <= other; ++i) {
          see(of_kind[i]);
        }
      }
    });
  }
}

/// Also calls `fall_silent` with each silence, before the element of that place.
/// @param silences Places in increasing order.
template <class All, class Place, class See, class FallSilent>
void in_order_of_arrival(All&& all, const std::vector<Place>& silences, See&& see,
                         FallSilent&& fall_silent) {
  auto next = silences.begin();
  in_order_of_arrival(all, [&](auto& element) {
    for (; next != silences.end() && *next <= place_of(element); ++next) {
      fall_silent(*next);
    }
    see(element);
  });
  for (; next != silences.end(); ++next) {
    fall_silent(*next);
  }
}

/// Also calls `see` with the elements of `more`, such as operator's actions.
/// @param more In order of their places, none of which occurs in `all`.
template <class All, class Place, class More, class See, class FallSilent>
void in_order_of_arrival(All&& all, const std::vector<Place>& silences, const More& more, See&& see,
                         FallSilent&& fall_silent) {
  auto next = more.begin();
  const auto see_those_before = [&](Place place) {
    for (; next != more.end() && place_of(*next) < place; ++next) {
      see(*next);
    }
  };
  in_order_of_arrival(
      all, silences,
      [&](auto& element) {
        see_those_before(place_of(element));
        see(element);
      },
      [&](Place place) {
        see_those_before(place);
        fall_silent(place);
      });
  see_those_before({std::numeric_limits<std::int64_t>::max()});
}

/// The highest seq of each session in the archive before a restart, for each kind in the order of
/// TelemetryKinds.
using LastOrigins = std::array<std::vector<Origin>, kTelemetryKindCount>;

/// Sorts the samples of a spacecraft: the natural key of stored samples, and the order in which
/// samples of equal time are read from files.
struct TelemetryOrder {
  TaiTime t;
  std::uint32_t kind;
  std::uint32_t place;
  friend constexpr auto operator<=>(const TelemetryOrder&, const TelemetryOrder&) = default;
};

template <class Value>
constexpr TelemetryOrder order_of(const Value& value) {
  TelemetryOrder order{.t = value.t, .kind = kTelemetryKind<Value>, .place = 0};
  if constexpr (requires { Telemetry<Value>::place(value); }) {
    order.place = static_cast<std::uint32_t>(Telemetry<Value>::place(value));
  }
  return order;
}

/// Kinds whose values carry the sender that they came from.
template <class Value>
concept HasSender = requires(const Value& value) {
  value.sender;
};

/// Returns whether one sample is a repetition of the other. @see say_the_same
template <class Value>
bool is_the_same_sample(const Value& one, const Value& other) {
  if constexpr (HasSender<Value>) {
    return one.t == other.t && say_the_same(one, other);
  }
  return order_of(one) == order_of(other);
}

}  // namespace spindrift
