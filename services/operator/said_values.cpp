#include "services/operator/said_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>

#include "pipelines/core/shown.h"
#include "services/base/json_line.h"
#include "services/telemetry/telemetry_time.h"

namespace spindrift {
namespace {

std::string said(const nlohmann::json& value) {
  std::string text = json_line(value);
  text.pop_back();
  return shown(text);
}

}  // namespace

bool SaidValues::has(const char* key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
    asked_.emplace_back(key);
  }
  return object_.contains(key);
}

const nlohmann::json* SaidValues::find(const char* key) {
  if (!has(key)) {
    wrong(fmt::format("{} is missing", key));
    return nullptr;
  }
  return &object_.at(key);
}

std::string SaidValues::text_or_empty(const char* key) {
  return has(key) && object_.at(key) != nlohmann::json("") ? text(key) : "";
}

std::string SaidValues::text(const char* key) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return {};
  }
  if (!value->is_string() || value->get_ref<const std::string&>().empty()) {
    wrong(fmt::format("{}: {}: must be text, not empty", key, said(*value)));
    return {};
  }
  auto text = value->get<std::string>();
  if (shown(text) != text) {
    wrong(fmt::format("{}: {}: must be at most {} characters, none of them a control character",
                      key, said(*value), kMostShown));
  }
  return text;
}

std::size_t SaidValues::name(const char* key, std::span<const std::string_view> names) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return 0;
  }
  const auto found = value->is_string() ? std::find(names.begin(), names.end(),
                                                    value->get_ref<const std::string&>())
                                        : names.end();
  if (found == names.end()) {
    wrong(fmt::format("{}: {}: must be one of {}", key, said(*value), fmt::join(names, ", ")));
    return 0;
  }
  return static_cast<std::size_t>(found - names.begin());
}

double SaidValues::number(const char* key, double at_least, double at_most) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return at_least;
  }
  // The condition is written so that NaN fails.
  if (!value->is_number() ||
      !(value->get<double>() >= at_least && value->get<double>() <= at_most)) {
    wrong(fmt::format("{}: {}: must be a number, {} to {}", key, said(*value), at_least, at_most));
    return at_least;
  }
  return value->get<double>();
}

std::optional<TaiTime> SaidValues::time_if(const char* key) {
  return has(key) ? std::optional{time(key)} : std::nullopt;
}

TaiTime SaidValues::time(const char* key) {
  const nlohmann::json* const value = find(key);
  if (value == nullptr) {
    return {};
  }
  const bool is_whole = value->is_number_integer() &&
                        (!value->is_number_unsigned() ||
                         value->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX));
  const TaiTime t = is_whole ? tai_from_ns(value->get<std::int64_t>()) : TaiTime::min();
  if (!is_telemetry_time(t)) {
    wrong(fmt::format("{}: {}: must be nanoseconds of TAI, {} to before {}", key, said(*value),
                      tai_ns(kEarliestTelemetry), tai_ns(kLatestTelemetry)));
  }
  return t;
}

std::string SaidValues::problems() const {
  std::vector<std::string> all = problems_;
  for (const auto& [key, value] : object_.items()) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
      all.push_back(fmt::format("{} is not known here: {}", shown(key),
                                asked_.empty() ? "nothing is asked for"
                                               : fmt::format("{} are", fmt::join(asked_, ", "))));
    }
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

}  // namespace spindrift
