/// @file
/// What people are told of the telemetry of a spacecraft while it comes, each thing once.

#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/mission/mission.h"
#include "services/processor/problems.h"
#include "services/processor/reach_watch.h"
#include "services/processor/source_watch.h"
#include "services/products/products.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

class RunNotices {
 public:
  explicit RunNotices(const Mission& mission);

  /// Which are left out, or agree again; that the one followed has the host's clock against it.
  /// @param products Receive each notice that is told; likewise below.
  void tell_sources(SourceWatch& sources, const Moment& moment, std::vector<Product>& products);
  /// @param carrier Followed until now, to `before`; empty: several.
  void tell_new_run(const SourceId& successor, TaiTime t, const std::optional<SourceId>& carrier,
                    TaiTime before) const;
  /// Sources that are left out.
  std::vector<SourceProblem> problems(const SourceWatch& sources) const;
  /// That both pulses and coded frames have arrived.
  void tell_both(std::vector<Product>& products);
  /// That telemetry has gaps.
  void tell_silences(const ReachWatch::Silences& silences, std::vector<Product>& products) const;
  /// Of each kind once: the mission has no sensor for it.
  void tell_undescribed(const TelemetrySamples& samples, std::vector<Product>& products);

 private:
  std::string spacecraft_id_;
  SpacecraftKind spacecraft_kind_;
  std::set<std::string> tables_;  ///< Of the mission file.
  bool told_both_ = false;
  std::array<bool, kTelemetryKindCount> told_undescribed_{};
  std::set<std::string> told_host_;  ///< Sources, by name.
};

}  // namespace spindrift
