/// @file
/// Spherical harmonic coefficients as IAGA and ESA exchange them (SHC).

#pragma once

#include <string_view>

#include "pipelines/core/expected.h"
#include "pipelines/geomagnetism/main_field.h"

namespace spindrift {

/// Reads an SHC text: comments after '#'; degrees from 1, number of epochs, order of the spline (2:
/// linear) and its steps (1); the epochs; then a row per coefficient with degree, order (negative:
/// of h), and its value at each epoch.
/// @return InvalidConfiguration with line and reason, also for other splines, degrees beyond
///         kHighestDegree and a coefficient that is there twice or not at all.
Expected<MainFieldModel> parse_shc(std::string_view text);

}  // namespace spindrift
