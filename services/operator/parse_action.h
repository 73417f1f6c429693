/// @file
/// Parses an operator's action from JSON.
///
/// A new action needs a type in spin_action.h or attitude_action.h, its effect on the pass (`act`),
/// its name and arguments in parse_action.cpp, and its name in schemas/tables.sql. Arguments are
/// stored as JSON and parsed by the same function again, so that what is repeated after a restart
/// is what was done.

#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "pipelines/core/expected.h"
#include "services/mission/spacecraft_kind.h"
#include "services/telemetry/operator_action.h"

namespace spindrift {

/// The spacecraft that actions may name.
using KnownSpacecraft = std::map<std::string, SpacecraftKind>;

/// Parses the body of POST /api/v1/actions: `spacecraft`, `by`, `action` and its arguments; `note`
/// and `t_tai_ns` are optional. A segment without `t_tai_ns` applies from its own beginning.
/// @return The action with an id and the current time; InvalidInput with all problems: key, value,
///         what is allowed.
Expected<OperatorAction> parse_action(const nlohmann::json& request, const KnownSpacecraft& known);

/// Parses the arguments of an action, also of one from an archive.
/// @return InvalidInput with all problems.
Expected<std::variant<SpinAction, AttitudeAction>> what_it_does(SpacecraftKind kind,
                                                                const std::string& action,
                                                                const nlohmann::json& arguments);

}  // namespace spindrift
