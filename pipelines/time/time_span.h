/// @file
/// Differences of arbitrary instants. Telemetry can claim any time, and the difference of two
/// claims may exceed 64 bits.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns `to - from`, saturated at the longest span.
constexpr std::chrono::nanoseconds span_between(TaiTime from, TaiTime to) {
  using Limits = std::numeric_limits<std::int64_t>;
  std::int64_t span_ns = 0;
  if (__builtin_sub_overflow(tai_ns(to), tai_ns(from), &span_ns)) {
    span_ns = to > from ? Limits::max() : Limits::min();
  }
  return std::chrono::nanoseconds{span_ns};
}

constexpr double elapsed_s(TaiTime from, TaiTime to) {
  return static_cast<double>(span_between(from, to).count()) * 1e-9;
}

/// Returns `t + span`, saturated at the first or last instant.
constexpr TaiTime later_by(TaiTime t, std::chrono::nanoseconds span) {
  using Limits = std::numeric_limits<std::int64_t>;
  std::int64_t sum_ns = 0;
  if (__builtin_add_overflow(tai_ns(t), span.count(), &sum_ns)) {
    sum_ns = span.count() > 0 ? Limits::max() : Limits::min();
  }
  return tai_from_ns(sum_ns);
}

constexpr TaiTime later_by_s(TaiTime t, double span_s) {
  constexpr double kMost_s = 9.2e9;  // About the range of 64-bit nanoseconds.
  const TaiTime zero = tai_from_ns(0);
  return later_by(t, shifted(zero, std::clamp(span_s, -kMost_s, kMost_s)) - zero);
}

}  // namespace spindrift
