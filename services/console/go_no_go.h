/// @file
/// Decides whether anything speaks against acting on what is known of a spacecraft.

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

/// The current knowledge about a spacecraft.
struct Standing {
  SpacecraftKind kind;
  LinkState link = LinkState::Waiting;
  std::optional<double> data_age_s = {};
  PassVerdict verdict = {};                  ///< Verdict on the run in force.
  std::optional<double> to_target_deg = {};  ///< Empty without target or axis.
  std::vector<Alert> alerts = {};            ///< Alerts that are open.
};

/// One reason against acting.
struct Objection {
  std::string_view code;
  std::string text;  ///< Sentence for people.
};

/// A warning that stands against nothing, since an operator has acknowledged it and it does not
/// bear on the answer.
struct AcceptedAlert {
  std::string key;
  Acknowledgement accepted;
  std::string text;  ///< Sentence for people: what, by whom and when.
};

struct GoNoGo {
  std::vector<Objection> against;  ///< Empty means go.
  std::vector<AcceptedAlert> accepted;
};

/// Anything unknown is an objection.
/// @param trouble Why the service takes or stores nothing; empty when it does.
GoNoGo go_no_go(const Standing& standing, const std::string& trouble, const AlertLimits& limits);

}  // namespace spindrift
