/// @file
/// Reads [alerts], [contact] and [spin.target] of a mission file.

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipelines/supervision/limits.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// @param values Values of a mission file without problems, or its `alert_values`.
AlertLimits alert_limits(const TomlValues& values);

/// Returns the values that `alert_limits` are made of.
TomlValues alert_values(const TomlValues& values);

/// The tables of [alerts] whose limits hold outside the contact.
inline constexpr std::string_view kBeforeContact = "before_aos";
inline constexpr std::string_view kAfterContact = "after_los";

/// Puts the limits of such a table in the place of those that hold in contact.
void put_phase(std::string_view phase, TomlValues& values);

/// Returns the place of a limit among the values, such as "alerts.spin.sigma.deg".
std::string limit_path(std::string_view key, std::string_view name);

/// Returns empty if the mission file has no contact. Adds a problem if it ends before it begins, or
/// if there are limits for outside it without it.
std::optional<Contact> planned_contact(TomlDocument& document);

/// Returns empty if the mission file has no target.
std::optional<SpinTarget> spin_target(const TomlValues& values);

}  // namespace spindrift
