/// @file
/// An operator's action out of JSON.

#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "pipelines/core/expected.h"
#include "services/mission/spacecraft_kind.h"
#include "services/telemetry/operator_action.h"

namespace spindrift {

/// Of whose telemetry something may be said.
using KnownSpacecraft = std::map<std::string, SpacecraftKind>;

/// As POST /api/v1/actions has it: `spacecraft`, `by`, `action` and its arguments; `note` and
/// `t_tai_ns` may be missing. A segment without `t_tai_ns` is of its own beginning on.
/// @return The action, with an id and as made now; InvalidInput with all that is wrong: key, value,
///         what is allowed.
Expected<OperatorAction> parse_action(const nlohmann::json& request, const KnownSpacecraft& known);

/// What an action of that name does with these arguments, which may be those of an archive.
/// @return InvalidInput likewise.
Expected<std::variant<SpinAction, AttitudeAction>> what_it_does(SpacecraftKind kind,
                                                                const std::string& action,
                                                                const nlohmann::json& arguments);

}  // namespace spindrift
