/// @file
/// Interprets an operator's action: which there are, and what each with its arguments does.
///
/// An action is interpreted here, whether it comes from the page, a command line or the archive. A
/// new one needs a type in spin_action.h or attitude_action.h, its effect on the pass (`act`), a
/// row of `kActions` in parse_action.cpp, its name in schemas/tables.sql and its form in
/// console/web/page/actions.js. Arguments are stored as JSON and parsed by the same function again,
/// so that what is repeated after a restart is what was done.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/mission/spacecraft_kind.h"
#include "services/operator/known_spacecraft.h"
#include "services/telemetry/operator_action.h"

namespace spindrift {

/// Parses the body of POST /api/v1/actions: `spacecraft`, `by`, `action` and its arguments; `note`
/// and `t_tai_ns` are optional. A segment without `t_tai_ns` applies from its own beginning.
/// @return The action with an id and the current time; InvalidInput with all problems: key, value,
///         what is allowed.
Expected<OperatorAction> parse_action(const nlohmann::json& request, const KnownSpacecraft& known);

/// What an action does, by the kind of spacecraft.
using ActionEffect = decltype(OperatorAction::does);

/// The telemetry that an action is about, where it names an end.
struct Segment {
  TaiTime from;
  TaiTime to;
};

/// Returns empty for an action without a segment.
std::optional<Segment> segment_in(const ActionEffect& does);

/// Parses the arguments of an action, also of one from an archive.
/// @return InvalidInput with all problems.
Expected<ActionEffect> what_it_does(SpacecraftKind kind, const std::string& action,
                                    const nlohmann::json& arguments);

/// Returns the names of all actions; of those of one kind of spacecraft where that is given.
std::vector<std::string_view> action_names(std::optional<SpacecraftKind> kind = {});

}  // namespace spindrift
