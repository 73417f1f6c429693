/// @file
/// A table of the field as the bytes that go on board: little-endian, float32 first anomaly (rad),
/// uint32 number of rows, the rows (nT), and of `Curvature` the knots (rad). The bytes do not say
/// of which kind they are.

#pragma once

#include <string>
#include <string_view>

#include "pipelines/geomagnetism/tables/field_table.h"

namespace spindrift {

std::string bytes_of(const FieldTable& table);

/// @return InvalidInput for bytes of another length, for values that no table of the kind has, and
///         for bytes that look like those of another kind.
Expected<FieldTable> table_of(std::string_view bytes, TableKind kind);

}  // namespace spindrift
