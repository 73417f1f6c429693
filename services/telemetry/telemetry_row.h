/// @file
/// Writes a value of a kind of telemetry as a row of a file.

#pragma once

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

/// @name Writers of one field
/// Numbers get the digits that reproduce the same double.
/// @{
inline void append_field(double value, std::string& row) {
  fmt::format_to(std::back_inserter(row), "{}", value);
}
inline void append_field(const std::optional<double>& value, std::string& row) {
  if (value) {
    append_field(*value, row);
  }
}
inline void append_field(PulseChannel channel, std::string& row) { row += name_of(channel); }
/// @}

/// Appends the columns of header_of (telemetry_layout.h) and a line feed.
template <class Value>
void append_row(const Value& value, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{}", tai_ns(value.t));
  for_each_column(value, [&text](std::string_view /*name*/, const auto& member) {
    text += ',';
    append_field(member, text);
  });
  text += '\n';
}

}  // namespace spindrift
