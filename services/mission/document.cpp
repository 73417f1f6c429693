#include "services/mission/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/base/input_file.h"
#include "services/mission/nesting.h"

namespace spindrift {

Expected<toml::table> parsed_toml(const std::filesystem::path& path, const std::string& text) {
  if (const auto line = line_nested_too_deep(text)) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}:{}: tables and arrays must not stand deeper than {} in each "
                                   "other",
                                   shown(path.string()), *line, kDeepestNesting)}};
  }
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    return Unexpected{
        {ErrorCode::InvalidConfiguration, fmt::format("{}:{}:{}: {}", shown(path.string()), at.line,
                                                      at.column, shown(error.description()))}};
  }
}

Expected<TomlDocument> read_document(const std::filesystem::path& path, const TableRule& schema) {
  return read_text_file(path).and_then(
      [&](std::string&& text) { return parse_document(path, std::move(text), schema); });
}

Expected<TomlDocument> parse_document(const std::filesystem::path& path, std::string text,
                                      const TableRule& schema) {
  auto table = parsed_toml(path, text);
  if (!table) {
    return Unexpected{std::move(table.error())};
  }
  auto [values, problems] = check_document(schema, *table);
  return TomlDocument{.path = path,
                      .text = std::move(text),
                      .table = std::move(*table),
                      .values = std::move(values),
                      .problems = std::move(problems)};
}

void add_problem(TomlDocument& document, std::string_view key, std::string text) {
  const toml::node* const node = document.table.at_path(key).node();
  document.problems.push_back(
      {.line = node == nullptr ? 0U : node->source().begin.line, .text = std::move(text)});
}

Expected<void> soundness(const TomlDocument& document) {
  if (document.problems.empty()) {
    return {};
  }
  // In file order; problems without a line come last, since 0 - 1 wraps to the largest line.
  std::vector<TomlProblem> problems = document.problems;
  std::stable_sort(problems.begin(), problems.end(),
                   [](const auto& a, const auto& b) { return a.line - 1 < b.line - 1; });
  const std::string file = shown(document.path.string());
  std::vector<std::string> lines;
  lines.reserve(problems.size());
  for (const TomlProblem& problem : problems) {
    lines.push_back(problem.line == 0 ? fmt::format("{}: {}", file, problem.text)
                                      : fmt::format("{}:{}: {}", file, problem.line, problem.text));
  }
  return Unexpected{{ErrorCode::InvalidConfiguration, fmt::format("{}", fmt::join(lines, "\n"))}};
}

}  // namespace spindrift
