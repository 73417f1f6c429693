/// @file
/// Whether anything stands against acting on what is known of a spacecraft.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/supervision/alert.h"
#include "pipelines/supervision/limits.h"
#include "services/mission/spacecraft_kind.h"
#include "services/products/pass_verdict.h"
#include "services/publisher/health.h"

namespace spindrift {

/// What is known of a spacecraft now.
struct Standing {
  SpacecraftKind kind;
  LinkState link = LinkState::Waiting;
  std::optional<double> data_age_s = {};
  PassVerdict verdict = {};                  ///< Of the run in force.
  std::optional<double> to_target_deg = {};  ///< Empty: no target, or no axis.
  std::vector<Alert> alerts = {};            ///< Open ones.
};

/// One thing that stands against it.
struct Objection {
  std::string_view code;
  std::string text;  ///< For people.
};

/// Unknown is never go.
/// @param trouble Why the service takes or stores nothing; empty: it does.
/// @return Empty: go.
std::vector<Objection> go_no_go(const Standing& standing, const std::string& trouble,
                                const AlertLimits& limits);

}  // namespace spindrift
