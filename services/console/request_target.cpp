#include "services/console/request_target.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "pipelines/core/shown.h"

namespace spindrift {
namespace {

Unexpected bad(const std::string& why) { return Unexpected{{ErrorCode::InvalidInput, why}}; }

/// Replaces percent escapes; returns empty for a malformed one.
std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const char first = text.front();
    text.remove_prefix(1);
    if (first != '%') {
      plain += first == '+' ? ' ' : first;
      continue;
    }
    unsigned char byte = 0;
    const char* const end = text.data() + 2;
    if (text.size() < 2 || std::from_chars(text.data(), end, byte, 16).ptr != end) {
      return std::nullopt;
    }
    plain += static_cast<char>(byte);
    text.remove_prefix(2);
  }
  return plain;
}

/// Removes the part before the next `sign`, and the sign itself, from `text`. @return The part.
std::string_view cut(std::string_view& text, char sign) {
  const std::string_view part = text.substr(0, text.find(sign));
  text.remove_prefix(part.size() == text.size() ? part.size() : part.size() + 1);
  return part;
}

}  // namespace

Expected<RequestTarget> request_target(std::string_view text) {
  const auto path = decoded(cut(text, '?'));
  if (!path) {
    return bad("the path has a % that begins no escape");
  }
  RequestTarget target{.path = *path, .query = {}};
  while (!text.empty()) {
    std::string_view value = cut(text, '&');
    const auto name = decoded(cut(value, '='));
    const auto plain = decoded(value);
    if (!name || !plain) {
      return bad("the query has a % that begins no escape");
    }
    if (!target.query.emplace(*name, *plain).second) {
      return bad(fmt::format("{} is given twice", shown(*name)));
    }
  }
  return target;
}

Expected<std::string> RequestTarget::text(const std::string& parameter) const {
  const auto found = query.find(parameter);
  return found == query.end() ? bad(fmt::format("{}: missing", parameter))
                              : Expected<std::string>{found->second};
}

Expected<std::int64_t> RequestTarget::integer(const std::string& parameter, std::int64_t least,
                                              std::int64_t most) const {
  return text(parameter).and_then([&](const std::string& value) -> Expected<std::int64_t> {
    const char* const end = value.data() + value.size();
    std::int64_t number = 0;
    const auto [rest, error] = std::from_chars(value.data(), end, number);
    if (error != std::errc{} || rest != end || number < least || number > most) {
      return bad(fmt::format("{} = {}: must be an integer from {} to {}", parameter, shown(value),
                             least, most));
    }
    return number;
  });
}

}  // namespace spindrift
