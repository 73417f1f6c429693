#include "services/scenario/mission_text.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

namespace spindrift {
namespace {

/// The library's own text gives a number in 17 digits.
std::string value_text(const toml::node& value) {
  if (const auto number = value.value_exact<double>()) {
    return fmt::format("{}", *number);
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
  append_table(*scenario.get_as<toml::table>("spin"), "spin", text);
  return text;
}

}  // namespace spindrift
