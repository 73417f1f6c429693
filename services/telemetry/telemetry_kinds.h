/// @file
/// The list of all kinds of telemetry, over which the services iterate.

#pragma once

#include <cstddef>
#include <type_traits>

#include "services/telemetry/coded_frame.h"
#include "services/telemetry/gyro.h"
#include "services/telemetry/magnetometer.h"
#include "services/telemetry/orbit_state.h"
#include "services/telemetry/pulse.h"
#include "services/telemetry/star.h"
#include "services/telemetry/sun.h"

namespace spindrift {

/// Represents a type as a value.
template <class Value>
struct Kind {
  using Type = Value;
  friend constexpr bool operator==(Kind /*one*/, Kind /*other*/) { return true; }
};

template <class... Values>
struct KindList {
  static constexpr std::size_t kSize = sizeof...(Values);

  /// Yields `Whole<Content<Values>...>`.
  template <template <class...> class Whole, template <class> class Content>
  using Of = Whole<Content<Values>...>;

  /// Returns the type's place in the list.
  template <class Value>
  static constexpr std::size_t index_of() {
    static_assert((std::is_same_v<Value, Values> || ...), "not a kind of the list");
    std::size_t index = 0;
    static_cast<void>(((std::is_same_v<Value, Values> || (++index, false)) || ...));
    return index;
  }

  /// Calls `see(Kind<Value>{})` for each type, in order.
  template <class See>
  static constexpr void for_each(See&& see) {
    (see(Kind<Values>{}), ...);
  }
};

using TelemetryKinds =
    KindList<Pulse, CodedFrame, GyroSample, StarFix, SunDirection, MagneticField, TimedOrbitState>;

}  // namespace spindrift
