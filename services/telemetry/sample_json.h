/// @file
/// Converts a sample to and from a JSON object of its columns.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "services/telemetry/telemetry.h"

namespace spindrift {

/// Keeps every bit of the numbers.
template <class Value>
std::string json_of_sample(const Value& value) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for_each_column(value, [&object]<class Member>(std::string_view name, const Member& member) {
    if constexpr (requires { member.has_value(); }) {
      object[std::string{name}] = member ? nlohmann::json(*member) : nlohmann::json{};
    } else {
      object[std::string{name}] = member;
    }
  });
  return object.dump();
}

/// Fills the columns of `value` from a text of `json_of_sample`. @throws nlohmann::json::exception
template <class Value>
void put_json(const std::string& text, Value& value) {
  const nlohmann::json object = nlohmann::json::parse(text);
  for_each_column(value, [&object]<class Member>(std::string_view name, Member& member) {
    const nlohmann::json& field = object.at(std::string{name});
    if constexpr (requires { member.has_value(); }) {
      member = field.is_null() ? std::nullopt : std::optional{field.get<double>()};
    } else {
      member = field.get<double>();
    }
  });
}

}  // namespace spindrift
