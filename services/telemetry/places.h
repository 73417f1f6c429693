/// @file
/// Numbers that order samples, silences and operator actions. Each series of numbers is a type of
/// its own, since a number of one says nothing in another.

#pragma once

#include <compare>
#include <cstdint>

namespace spindrift {

/// Place among the elements of one batch. From files the batch is counted; from the bus a place is
/// the time of writing in nanoseconds by the writer's clock.
struct BatchPlace {
  std::int64_t number = 0;
  friend constexpr auto operator<=>(const BatchPlace&, const BatchPlace&) = default;
};

/// Place in the order of arrival of a spacecraft, which goes on from run to run: `arrival` and
/// `first_arrival` in schemas/tables.sql.
struct RunPlace {
  std::int64_t number = 0;
  friend constexpr auto operator<=>(const RunPlace&, const RunPlace&) = default;
};

constexpr RunPlace place_after(RunPlace place) { return {place.number + 1}; }

}  // namespace spindrift
