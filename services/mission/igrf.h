/// @file
/// The embedded International Geomagnetic Reference Field, 14th generation.
///
/// IGRF14.shc is IAGA's file as stored in IAGA-VMOD/ppigrf, commit 5c45795b. It covers 1900 to
/// 2030: it is definitive from 1945 to 2020, may be revised from then to 2025, and is a prediction
/// after that. The file of the next generation will replace it.

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
