#include "services/mission/nesting.h"

#include <algorithm>
#include <cstddef>
#include <string>

namespace spindrift {
namespace {

class Scan {
 public:
  explicit Scan(std::string_view text) : rest_{text} {}

  std::optional<std::uint32_t> line_too_deep() {
    while (!rest_.empty()) {
      pass_next();
      if (brackets_ > kDeepestNesting || names_ > kDeepestNesting) {
        return line_;
      }
    }
    return std::nullopt;
  }

 private:
  void pass_next() {
    const char c = rest_.front();
    if (c == '"' || c == '\'') {
      pass_text(c);
      return;
    }
    if (c == '#') {
      pass(std::min(rest_.find('\n'), rest_.size()));
      return;
    }
    if (c == '.') {
      ++names_;
    } else if (std::string_view{"[]{},=\n"}.find(c) != std::string_view::npos) {
      names_ = 1;
      brackets_ += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    }
    pass(1);
  }

  /// Skips a quoted text: on one line, or on several in triple quotes.
  void pass_text(char quote) {
    const std::string three(3, quote);
    const bool several_lines = rest_.starts_with(three);
    const std::string_view end = several_lines ? three : std::string_view{three}.substr(0, 1);
    pass(end.size());
    while (!rest_.empty() && !rest_.starts_with(end)) {
      if (rest_.front() == '\n' && !several_lines) {
        return;  // The text is not valid TOML.
      }
      pass(rest_.front() == '\\' && quote == '"' ? 2 : 1);
    }
    pass(end.size());
    // Up to two quotes may precede the end of a multi-line text.
    for (int more = 0; several_lines && more < 2 && rest_.starts_with(quote); ++more) {
      pass(1);
    }
  }

  void pass(std::size_t count) {
    const std::string_view passed = rest_.substr(0, count);
    line_ += static_cast<std::uint32_t>(std::count(passed.begin(), passed.end(), '\n'));
    rest_.remove_prefix(passed.size());
  }

  std::string_view rest_;
  std::uint32_t line_ = 1;
  int brackets_ = 0;
  int names_ = 1;  ///< Number of names in the current key.
};

}  // namespace

std::optional<std::uint32_t> line_nested_too_deep(std::string_view text) {
  return Scan{text}.line_too_deep();
}

}  // namespace spindrift
