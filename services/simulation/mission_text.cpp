#include "services/simulation/mission_text.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>
#include <vector>

namespace spindrift {
namespace {

/// Formats a value here, as the TOML library would write a number with 17 digits.
std::string value_text(const toml::node& value) {
  if (const auto number = value.value_exact<double>()) {
    return fmt::format("{}", *number);
  }
  if (const toml::array* const array = value.as_array()) {
    std::vector<std::string> elements;
    for (const toml::node& element : *array) {
      elements.push_back(value_text(element));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  std::ostringstream text;
  value.visit([&](const auto& node) { text << node; });
  return text.str();
}

void append_table(const toml::table& table, const std::string& path, std::string& text) {
  std::string values;
  for (const auto& [key, node] : table) {
    if (!node.is_table()) {
      values += fmt::format("{} = {}\n", key.str(), value_text(node));
    }
  }
  if (!values.empty()) {
    text += fmt::format("\n[{}]\n{}", path, values);
  }
  for (const auto& [key, node] : table) {
    if (const toml::table* const inner = node.as_table()) {
      append_table(*inner, fmt::format("{}.{}", path, key.str()), text);
    }
  }
}

}  // namespace

std::string mission_text(const toml::table& scenario) {
  std::string text = "# Written by spindrift simulate for the pass beside it.\n";
  append_table(*scenario.get_as<toml::table>("spacecraft"), "spacecraft", text);
  text += "\n[orbit]\noem = \"orbit.oem\"\n";
  for (const char* const sensors : {"spin", "three_axis"}) {
    if (const toml::table* const table = scenario.get_as<toml::table>(sensors)) {
      append_table(*table, sensors, text);
    }
  }
  return text;
}

}  // namespace spindrift
