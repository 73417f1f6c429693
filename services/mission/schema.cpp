#include "services/mission/schema.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "services/mission/key_check.h"
#include "services/mission/toml_scalar.h"

namespace spindrift {

namespace {

constexpr std::array<std::pair<std::string_view, ValueType>, 4> kTypes = {
    {{"text", ValueType::Text},
     {"boolean", ValueType::Boolean},
     {"integer", ValueType::Integer},
     {"number", ValueType::Number}}};

constexpr std::array<std::pair<std::string_view, ValueForm>, 4> kForms = {
    {{"spacecraft_id", ValueForm::SpacecraftId},
     {"unit_quaternion", ValueForm::UnitQuaternion},
     {"inertia", ValueForm::Inertia},
     {"utc", ValueForm::Utc}}};

constexpr std::array<std::string_view, 13> kKeyProperties = {
    "type",  "shape",    "unit",    "about",          "default", "optional", "above",
    "below", "at_least", "at_most", "not_below_keys", "one_of",  "form"};

constexpr std::array<std::string_view, 4> kTableProperties = {"about", "required", "many",
                                                              "exactly_one_of"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

template <class Table>
auto named(const Table& table, std::string_view name) {
  const auto* const found = std::find_if(table.begin(), table.end(),
                                         [&](const auto& entry) { return entry.first == name; });
  return found == table.end() ? std::nullopt : std::optional{found->second};
}

Unexpected refused(std::string_view path, std::string_view reason) {
  return Unexpected{{ErrorCode::InvalidConfiguration, fmt::format("schema: {}: {}", path, reason)}};
}

std::string text_of(const toml::table& rule, std::string_view property) {
  return rule[property].value_or(std::string{});
}

std::vector<std::string> texts_of(const toml::table& rule, std::string_view property) {
  std::vector<std::string> texts;
  if (const toml::array* const array = rule[property].as_array()) {
    array->for_each([&](const toml::value<std::string>& text) { texts.push_back(*text); });
  }
  return texts;
}

std::vector<std::size_t> shape_of(const toml::table& rule) {
  std::vector<std::size_t> shape;
  if (const toml::array* const array = rule["shape"].as_array()) {
    array->for_each([&](const toml::value<std::int64_t>& size) {
      shape.push_back(static_cast<std::size_t>(*size));
    });
  }
  return shape;
}

std::optional<Bound> bound_of(const toml::table& rule, std::string_view inclusive,
                              std::string_view exclusive) {
  const toml::node* const in = rule.get(inclusive);
  const toml::node* const node = in != nullptr ? in : rule.get(exclusive);
  if (node == nullptr || !node->is_number()) {
    return std::nullopt;
  }
  return Bound{.value = *scalar_from(*node), .inclusive = in != nullptr};
}

Expected<KeyRule> key_rule(const toml::table& rule, const std::string& path) {
  for (const auto& [property, node] : rule) {
    if (!contains(kKeyProperties, property.str())) {
      return refused(path, fmt::format("no meaning is known for '{}'", property.str()));
    }
  }
  const auto type = named(kTypes, text_of(rule, "type"));
  if (!type) {
    return refused(path, "type must be text, boolean, integer or number");
  }
  const auto form = named(kForms, text_of(rule, "form"));
  if (rule.contains("form") && !form) {
    return refused(path, "the form is not known");
  }
  KeyRule result{.type = *type,
                 .shape = shape_of(rule),
                 .unit = text_of(rule, "unit"),
                 .about = text_of(rule, "about"),
                 .default_value = std::nullopt,
                 .optional = rule["optional"].value_or(false),
                 .lower = bound_of(rule, "at_least", "above"),
                 .upper = bound_of(rule, "at_most", "below"),
                 .not_below_keys = texts_of(rule, "not_below_keys"),
                 .one_of = texts_of(rule, "one_of"),
                 .form = form};
  const bool numeric = *type == ValueType::Integer || *type == ValueType::Number;
  if (numeric && !(result.lower && result.upper)) {
    return refused(path, "needs a lower and an upper bound");
  }
  if (result.about.empty()) {
    return refused(path, "needs an 'about'");
  }
  if (const toml::node* const node = rule.get("default")) {
    if (const auto wrong = objection(result, *node)) {
      return refused(path, fmt::format("the default {}", *wrong));
    }
    result.default_value = typed(*type, *node);
  }
  return result;
}

Expected<TableRule> table_rule(const toml::table& table, const std::string& path) {
  TableRule rule{.about = text_of(table, "about"),
                 .required = text_of(table, "required"),
                 .many = table["many"].value_or(false),
                 .exactly_one_of = texts_of(table, "exactly_one_of"),
                 .moved = {},
                 .keys = {},
                 .tables = {}};
  for (const auto& [key, node] : table) {
    const std::string name{key.str()};
    const std::string inner_path = path.empty() ? name : fmt::format("{}.{}", path, name);
    const toml::table* const inner = node.as_table();
    if (inner == nullptr) {
      if (!contains(kTableProperties, name)) {
        return refused(path, fmt::format("no meaning is known for '{}'", name));
      }
    } else if (inner->contains("moved")) {
      rule.moved.emplace(name, text_of(*inner, "moved"));
    } else if (inner->contains("type")) {
      auto key_of = key_rule(*inner, inner_path);
      if (!key_of) {
        return Unexpected{std::move(key_of.error())};
      }
      rule.keys.emplace(name, std::move(*key_of));
    } else {
      auto inner_rule = table_rule(*inner, inner_path);
      if (!inner_rule) {
        return inner_rule;
      }
      rule.tables.emplace(name, std::move(*inner_rule));
    }
  }
  return rule;
}

}  // namespace

Expected<TableRule> parse_schema(std::string_view text) {
  try {
    return table_rule(toml::parse(text), "");
  } catch (const toml::parse_error& error) {
    return refused(fmt::format("line {}", error.source().begin.line), error.description());
  }
}

}  // namespace spindrift
