/// @file
/// Checks that a text is well-formed XML, limited to what the project's SVG uses: elements,
/// attributes in double quotes, and text; no comments or declarations.

#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace spindrift::testing {

/// @return Description of the first problem; empty if there is none.
inline std::string xml_problem(const std::string& text) {
  static const std::regex kTag{R"(^<(/?)([A-Za-z][\w.-]*)((?:\s+[\w:.-]+="[^"<>]*")*)\s*(/?)>)"};
  static const std::regex kBareAmpersand{"&(?!(amp|lt|gt|quot|apos);)"};
  if (std::regex_search(text, kBareAmpersand)) {
    return "an & that is not escaped";
  }
  if (std::any_of(text.begin(), text.end(),
                  [](char c) { return c >= 0 && c < ' ' && c != '\n'; })) {
    return "a control character";
  }
  std::vector<std::string> open;
  std::size_t roots = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    // Long lists of points are cut out because std::regex recurses on the stack.
    const std::size_t end = text.find('>', at);
    std::string tag = text.substr(at, end == std::string::npos ? end : end - at + 1);
    if (const std::size_t points = tag.find("points=\""); points != std::string::npos) {
      tag.erase(points + 8, tag.find('"', points + 8) - points - 8);
    }
    std::smatch match;
    if (!std::regex_match(tag, match, kTag)) {
      return "not a tag: " + tag.substr(0, 60);
    }
    if (match[1].length() > 0) {
      if (open.empty() || open.back() != match[2]) {
        return "closes what is not open: " + tag;
      }
      open.pop_back();
    } else if (match[4].length() == 0) {
      roots += open.empty() ? 1 : 0;
      open.push_back(match[2]);
    }
  }
  if (!open.empty()) {
    return "never closed: " + open.back();
  }
  return roots == 1 ? "" : "not one root";
}

}  // namespace spindrift::testing
