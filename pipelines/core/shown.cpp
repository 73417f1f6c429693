#include "pipelines/core/shown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace spindrift {
namespace {

constexpr std::string_view kCut = "...";

unsigned byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// Returns the length that the first byte of a UTF-8 character implies; 0 if it cannot start one.
std::size_t length_by(unsigned first) {
  if (first < 0x80U) {
    return 1;
  }
  if (first < 0xC2U || first > 0xF4U) {
    return 0;
  }
  return first < 0xE0U ? 2 : first < 0xF0U ? 3 : 4;
}

/// Rejects overlong encodings, UTF-16 surrogates and codes beyond U+10FFFF.
bool is_character(std::uint32_t code, std::size_t length) {
  return length == 1 || length == 2 ||
         (length == 3 ? code >= 0x800U && (code < 0xD800U || code > 0xDFFFU)
                      : code >= 0x10000U && code <= 0x10FFFFU);
}

bool can_be_shown(std::uint32_t code) {
  const bool control = code < 0x20U || (code >= 0x7FU && code < 0xA0U);
  const bool separates_lines = code == 0x2028U || code == 0x2029U;
  const bool turns_writing = code == 0x61CU || code == 0x200EU || code == 0x200FU ||
                             (code >= 0x202AU && code <= 0x202EU) ||
                             (code >= 0x2066U && code <= 0x2069U);
  return !control && !separates_lines && !turns_writing;
}

/// Returns the length of the first character if it can be shown unchanged; else 0.
std::size_t character_at_front(std::string_view text) {
  const std::size_t length = length_by(byte_at(text, 0));
  if (length == 0 || length > text.size()) {
    return 0;
  }
  std::uint32_t code = length == 1 ? byte_at(text, 0) : byte_at(text, 0) & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, i) & 0xC0U) != 0x80U) {
      return 0;
    }
    code = code << 6U | (byte_at(text, i) & 0x3FU);
  }
  return is_character(code, length) && can_be_shown(code) ? length : 0;
}

}  // namespace

std::string shown(std::string_view text) {
  const auto is_plain = [](char c) { return c >= ' ' && c <= '~'; };
  if (text.size() <= kMostShown && std::all_of(text.begin(), text.end(), is_plain)) {
    return std::string{text};  // Fast path for nearly every telemetry sample.
  }
  std::string shown;
  for (std::size_t characters = 0; !text.empty();) {
    const std::size_t length = character_at_front(text);
    const std::string escaped = length == 0 ? fmt::format("\\x{:02x}", byte_at(text, 0)) : "";
    characters += length == 0 ? escaped.size() : 1;
    if (characters > kMostShown) {
      return shown += kCut;
    }
    shown += length == 0 ? escaped : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return shown;
}

}  // namespace spindrift
