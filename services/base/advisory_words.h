/// @file
/// Advice about a lost attitude in words for people.

#pragma once

#include <string>

#include "pipelines/three_axis/products.h"

namespace spindrift {

/// Returns for example "body lost, by field and Sun: the field is 12.3 deg off that of the
/// commanded attitude; sun, magnetometer speak; gyro silent; no attitude known; no control before
/// the safe gate opens".
std::string sentence_of(const Advisory& advisory);

}  // namespace spindrift
