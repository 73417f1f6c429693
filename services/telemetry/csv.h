/// @file
/// Splits the plain CSV of telemetry, which has no quotes and no escapes.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace spindrift {

/// The fields of a line, without allocation: "a,,b" has three.
class CsvFields {
 public:
  explicit CsvFields(std::string_view line);

  /// Counts all fields of the line.
  std::size_t count() const { return count_; }

  /// Returns at most the first kMost fields; no telemetry has more columns.
  std::span<const std::string_view> fields() const {
    return {fields_.data(), std::min(count_, kMost)};
  }

  /// Removes and returns one of `fields()`; those behind it move up.
  std::string_view remove(std::size_t column);

  friend bool operator==(const CsvFields& a, const CsvFields& b) {
    return std::ranges::equal(a.fields(), b.fields()) && a.count_ == b.count_;
  }

 private:
  static constexpr std::size_t kMost = 8;

  std::array<std::string_view, kMost> fields_;
  std::size_t count_ = 0;
};

/// Escapes the text as in shown.h and adds quotes.
std::string quoted(std::string_view text);

}  // namespace spindrift
