/// @file
/// The International Geomagnetic Reference Field, 14th generation, which the program holds.

#pragma once

#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr std::string_view kFieldModelName = "IGRF-14";

/// @return the errors of parse_shc: of a program that was built with another file.
Expected<MainFieldModel> igrf();

/// When its last epoch is: then it ends.
TaiTime igrf_end();

}  // namespace spindrift
