/// @file
/// Parses the columns of a telemetry row.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "pipelines/core/expected.h"
#include "pipelines/spin/types/pulse.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

using RowFields = std::span<const std::string_view>;

/// @name Parsers of one field into one member of a value
/// @return Empty, or why the field cannot be read, naming column, field and what is allowed.
/// @{
std::string parse_field(std::string_view column, std::string_view field, TaiTime& t);
std::string parse_field(std::string_view column, std::string_view field, double& number);
/// An empty field means not received.
std::string parse_field(std::string_view column, std::string_view field,
                        std::optional<double>& number);
std::string parse_field(std::string_view column, std::string_view field, PulseChannel& channel);
/// @}

/// @param fields All columns of the kind, without `spacecraft`.
/// @return InvalidInput naming column, value and what is allowed (telemetry_time.h, and the traits
///         of the kind).
template <class Value>
Expected<void> parse_row(RowFields fields, Value& value) {
  std::string reason = parse_field("t_tai_ns", fields[0], value.t);
  std::size_t column = 0;
  for_each_column(value, [&](std::string_view name, auto& member) {
    ++column;
    if (reason.empty()) {
      reason = parse_field(name, fields[column], member);
    }
  });
  if (reason.empty()) {
    reason = Telemetry<Value>::why_impossible(value);
  }
  if (!reason.empty()) {
    return Unexpected{{ErrorCode::InvalidInput, std::move(reason)}};
  }
  return {};
}

}  // namespace spindrift
