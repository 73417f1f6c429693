/// @file
/// The embedded International Geomagnetic Reference Field, 14th generation.

#pragma once

#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr std::string_view kFieldModelName = "IGRF-14";

/// @return The errors of parse_shc, possible only if the program was built with another file.
Expected<MainFieldModel> igrf();

/// Returns the last epoch of the model, after which it is not valid.
TaiTime igrf_end();

}  // namespace spindrift
