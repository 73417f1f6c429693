#include "pipelines/ephemeris/oem_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

std::string upper_case(std::string_view text) {
  std::string upper{text};
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return upper;
}

/// Returns the time of `key`, or `otherwise` without that key; it must lie within the span.
Expected<TaiTime> time_within(const OemEntries& entries, std::string_view key,
                              const OemMetadata& meta, TaiTime otherwise) {
  if (!entries.contains(key)) {
    return otherwise;
  }
  Expected<TaiTime> time = oem_time(entries, key, meta.read_time);
  if (time && (*time < meta.start || *time > meta.stop)) {
    return oem_refused(key, entries.at(key), "must lie between START_TIME and STOP_TIME");
  }
  return time;
}

Expected<void> check_frame(const OemEntries& entries) {
  constexpr std::array<std::string_view, 1> kCenters = {"EARTH"};
  constexpr std::array<std::string_view, 4> kFrames = {"EME2000", "J2000", "GCRF", "ICRF"};
  if (const auto center = oem_choice(entries, "CENTER_NAME", kCenters); !center) {
    return Unexpected{center.error()};
  }
  if (const auto frame = oem_choice(entries, "REF_FRAME", kFrames); !frame) {
    return Unexpected{frame.error()};
  }
  return {};
}

Expected<OemReadTime> read_time_of(const OemEntries& entries) {
  constexpr std::array<std::string_view, 2> kTimeSystems = {"UTC", "TAI"};
  return oem_choice(entries, "TIME_SYSTEM", kTimeSystems).map([](const std::string& system) {
    return system == "UTC" ? OemReadTime{parse_utc} : OemReadTime{parse_tai};
  });
}

Expected<void> set_times(const OemEntries& entries, OemMetadata& meta) {
  if (entries.contains("REF_FRAME_EPOCH")) {
    if (const auto epoch = oem_time(entries, "REF_FRAME_EPOCH", meta.read_time); !epoch) {
      return Unexpected{epoch.error()};
    }
  }
  const Expected<TaiTime> start = oem_time(entries, "START_TIME", meta.read_time);
  if (!start) {
    return Unexpected{start.error()};
  }
  const Expected<TaiTime> stop = oem_time(entries, "STOP_TIME", meta.read_time);
  if (!stop) {
    return Unexpected{stop.error()};
  }
  meta.start = *start;
  meta.stop = *stop;
  const auto usable_start = time_within(entries, "USEABLE_START_TIME", meta, meta.start);
  if (!usable_start) {
    return Unexpected{usable_start.error()};
  }
  const auto usable_stop = time_within(entries, "USEABLE_STOP_TIME", meta, meta.stop);
  if (!usable_stop) {
    return Unexpected{usable_stop.error()};
  }
  meta.usable_start = *usable_start;
  meta.usable_stop = *usable_stop;
  return {};
}

Expected<void> set_interpolation(const OemEntries& entries, OemMetadata& meta) {
  constexpr std::array<std::string_view, 2> kInterpolations = {"LAGRANGE", "HERMITE"};
  const auto degree = entries.find("INTERPOLATION_DEGREE");
  if (!entries.contains("INTERPOLATION")) {
    if (degree != entries.end()) {
      return oem_refused(degree->first, degree->second, "needs INTERPOLATION beside it");
    }
    return {};
  }
  const auto interpolation = oem_choice(entries, "INTERPOLATION", kInterpolations);
  if (!interpolation) {
    return Unexpected{interpolation.error()};
  }
  if (degree == entries.end()) {
    return oem_refused("INTERPOLATION", entries.at("INTERPOLATION"),
                       "needs INTERPOLATION_DEGREE beside it");
  }
  const std::optional<double> number = oem_number(degree->second.value);
  if (!number || *number != std::floor(*number) || *number < 1 ||
      *number > kMaxInterpolationDegree) {
    return oem_refused(degree->first, degree->second,
                       fmt::format("must be a whole number from 1 to {}", kMaxInterpolationDegree));
  }
  meta.interpolation =
      *interpolation == "LAGRANGE" ? Interpolation::Lagrange : Interpolation::Hermite;
  meta.degree = static_cast<int>(*number);
  return {};
}

}  // namespace

Unexpected oem_refused(int line, std::string_view what) {
  return Unexpected{
      {ErrorCode::InvalidConfiguration, fmt::format("orbit ephemeris, line {}: {}", line, what)}};
}

Unexpected oem_refused(std::string_view key, const OemEntry& entry, std::string_view what) {
  return oem_refused(entry.line, fmt::format("{} = {}: {}", shown(key), shown(entry.value), what));
}

std::optional<double> oem_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
  }
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  return whole && std::isfinite(number) ? std::optional{number} : std::nullopt;
}

Expected<std::string> oem_choice(const OemEntries& entries, std::string_view key,
                                 std::span<const std::string_view> allowed) {
  const OemEntry& entry = entries.at(key);
  std::string value = upper_case(entry.value);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    return oem_refused(key, entry, fmt::format("must be {}", fmt::join(allowed, " or ")));
  }
  return value;
}

Expected<TaiTime> oem_time(const OemEntries& entries, std::string_view key, OemReadTime read_time) {
  const OemEntry& entry = entries.at(key);
  return read_time(entry.value).map_error([&](const Error& error) {
    return oem_refused(key, entry, error.message).value();
  });
}

Expected<OemMetadata> oem_metadata_from(const OemEntries& entries) {
  OemMetadata meta;
  meta.object_name = entries.at("OBJECT_NAME").value;
  meta.object_id = entries.at("OBJECT_ID").value;
  return check_frame(entries)
      .and_then([&] { return read_time_of(entries); })
      .and_then([&](OemReadTime read_time) {
        meta.read_time = read_time;
        return set_times(entries, meta);
      })
      .and_then([&] { return set_interpolation(entries, meta); })
      .map([&] { return meta; });
}

}  // namespace spindrift
