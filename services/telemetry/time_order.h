/// @file
/// Puts telemetry of all kinds in the order of its times.

#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "services/telemetry/by_kind.h"

namespace spindrift {

/// Sets `arrival` as if files were merged. @param all Each kind is in order already.
inline void put_in_order(TelemetryValues& all) {
  std::vector<std::pair<TelemetryOrder, std::int64_t*>> places;
  all.for_each([&](auto& of_kind) {
    for (auto& arrived : of_kind) {
      places.emplace_back(order_of(arrived.value), &arrived.arrival);
    }
  });
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    *places[i].second = static_cast<std::int64_t>(i);
  }
}

}  // namespace spindrift
