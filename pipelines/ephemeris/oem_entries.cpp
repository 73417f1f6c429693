#include "pipelines/ephemeris/oem_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

std::string upper_case(std::string_view text) {
  std::string upper{text};
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return upper;
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

}  // namespace spindrift
