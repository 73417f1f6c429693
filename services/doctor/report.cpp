#include "services/doctor/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "services/base/counted.h"
#include "services/base/json_line.h"

namespace spindrift::doctor {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::array<std::string_view, 3> kNames = {"ok", "warning", "failure"};
// Upper case, so that problems stand out without colours.
constexpr std::array<std::string_view, 3> kMarks = {"ok", "WARNING", "FAILURE"};
constexpr std::size_t kMarkWidth = 9;

/// Breaks the lines of `text` between words at `width` and indents continuations by two.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    std::string indent;
    while (indent.size() + line.size() > width) {
      const std::size_t room = width - indent.size();
      std::size_t cut = line.rfind(' ', room);
      cut = cut == std::string_view::npos || cut == 0 ? line.find(' ', room) : cut;
      if (cut == std::string_view::npos) {
        break;
      }
      lines.push_back(indent + std::string{line.substr(0, cut)});
      line.remove_prefix(cut + 1);
      indent = "  ";
    }
    lines.push_back(indent + std::string{line});
  }
  return lines;
}

std::string entry(const Check& check, std::size_t name_width) {
  const std::size_t indent = kMarkWidth + name_width + 2;
  std::string text;
  for (const std::string& line : wrapped(check.found, kWidth - indent)) {
    text += text.empty() ? fmt::format("{:<{}}{:<{}}{}\n",
                                       kMarks.at(static_cast<std::size_t>(check.verdict)),
                                       kMarkWidth, check.name, name_width + 2, line)
                         : fmt::format("{:{}}{}\n", "", indent, line);
  }
  std::string_view arrow = "-> ";
  for (const std::string& line : wrapped(check.advice, kWidth - indent - arrow.size())) {
    text += fmt::format("{:{}}{:3}{}\n", "", indent, arrow, line);
    arrow = "";
  }
  return text;
}

}  // namespace

Verdict worst_of(std::span<const Check> checks) {
  Verdict worst = Verdict::Ok;
  for (const Check& check : checks) {
    worst = std::max(worst, check.verdict);
  }
  return worst;
}

std::string to_text(std::span<const Check> checks, bool verbose) {
  std::size_t name_width = 0;
  for (const Check& check : checks) {
    name_width = std::max(name_width, check.name.size());
  }
  std::string text;
  for (const Check& check : checks) {
    if (verbose || check.verdict != Verdict::Ok) {
      text += entry(check, name_width);
    }
  }
  const auto count = [&](Verdict verdict) {
    return std::count_if(checks.begin(), checks.end(),
                         [&](const Check& check) { return check.verdict == verdict; });
  };
  return text + fmt::format("{}{}, {}, {} sound\n", text.empty() ? "" : "\n",
                            counted(count(Verdict::Failure), "failures"),
                            counted(count(Verdict::Warning), "warnings"), count(Verdict::Ok));
}

std::string to_json(std::span<const Check> checks) {
  const auto name_of = [](Verdict verdict) { return kNames.at(static_cast<std::size_t>(verdict)); };
  nlohmann::json list = nlohmann::json::array();
  for (const Check& check : checks) {
    list.push_back({{"name", check.name},
                    {"verdict", name_of(check.verdict)},
                    {"found", check.found},
                    {"advice", check.advice}});
  }
  const nlohmann::json report{{"verdict", name_of(worst_of(checks))}, {"checks", std::move(list)}};
  return json_line(report);
}

}  // namespace spindrift::doctor
