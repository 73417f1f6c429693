#include "services/base/reasons_json.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

namespace spindrift {
namespace {

// Ordered, to keep the members as given.
using Json = nlohmann::ordered_json;

std::optional<ReasonCode> code_named(std::string_view name) {
  for (int i = 0; i < kReasonCodes; ++i) {
    if (const auto code = static_cast<ReasonCode>(i); name_of(code) == name) {
      return code;
    }
  }
  return std::nullopt;
}

std::optional<NamedValue::Value> value_of(const Json& json) {
  if (json.is_number_integer()) {
    return json.get<std::int64_t>();
  }
  if (json.is_number()) {
    return json.get<double>();
  }
  if (json.is_string()) {
    return json.get<std::string>();
  }
  return std::nullopt;
}

std::optional<Reason> reason_of(const Json& json) {
  const auto named = json.is_object() ? json.find("code") : json.end();
  const auto code = named != json.end() && named->is_string()
                        ? code_named(named->get_ref<const std::string&>())
                        : std::nullopt;
  if (!code) {
    return std::nullopt;
  }
  Reason reason{*code};
  for (const auto& [name, value] : json.items()) {
    if (auto read = value_of(value); read && name != "code") {
      reason.values.push_back({name, *std::move(read)});
    }
  }
  return reason;
}

}  // namespace

std::string to_json_text(std::span<const Reason> reasons) {
  Json json = Json::array();
  for (const Reason& reason : reasons) {
    Json object{{"code", name_of(reason.code)}};
    for (const NamedValue& value : reason.values) {
      std::visit([&](const auto& is) { object[value.name] = is; }, value.value);
    }
    json.push_back(std::move(object));
  }
  return json.dump();
}

std::vector<Reason> reasons_of(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  std::vector<Reason> reasons;
  for (const Json& object : json.is_array() ? json : Json::array()) {
    if (auto reason = reason_of(object)) {
      reasons.push_back(*std::move(reason));
    }
  }
  return reasons;
}

}  // namespace spindrift
