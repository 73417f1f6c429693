/// @file
/// [alerts], [contact] and [spin.target] of a mission file.

#pragma once

#include <optional>

#include "pipelines/supervision/limits.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// `values` are those of a mission file in which no problem was found.
AlertLimits alert_limits(const TomlValues& values);

/// Empty: the mission file names none. Adds the problem of one that ends before it begins.
std::optional<Contact> planned_contact(TomlDocument& document);

/// Empty: the mission file names none.
std::optional<SpinTarget> spin_target(const TomlValues& values);

}  // namespace spindrift
