/// @file
/// Puts telemetry of all kinds in the order of its times.

#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "services/telemetry/by_kind.h"

namespace spindrift {

/// Sets places as if files were merged. @param all Each kind is in order already.
inline void put_in_order(PlacedValues& all) {
  std::vector<std::pair<TelemetryOrder, BatchPlace*>> places;
  all.for_each([&](auto& of_kind) {
    for (auto& placed : of_kind) {
      places.emplace_back(order_of(placed.value), &placed.place);
    }
  });
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].second->number = static_cast<std::int64_t>(i);
  }
}

}  // namespace spindrift
