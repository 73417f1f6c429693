/// @file
/// Reports to the user about the telemetry of a spacecraft while it arrives, each fact once.

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

  /// Reports which sources are left out or agree again.
  /// @param products Receive each notice that is reported; the same holds for the functions below.
  void tell_sources(SourceWatch& sources, std::vector<Product>& products) const;
  /// Reports that the telemetry of a source is the clock instead of the host's. The notice holds no
  /// time of the host and no session, so that the same telemetry gives the same one.
  /// @param t Time of its telemetry.
  RunNotice clock_told(const std::string& source, TaiTime t) const;
  /// Logs that a new run begins with another source.
  /// @param leader Source whose telemetry was the clock until now; empty when the host's was.
  /// @param before Time that the pass had reached with it.
  void tell_new_run(const SourceId& successor, TaiTime t, const std::optional<SourceId>& leader,
                    TaiTime before) const;
  std::vector<SourceProblem> problems(const SourceWatch& sources) const;
  /// Reports that both pulses and coded frames have arrived.
  void tell_both(std::vector<Product>& products);
  void tell_silences(const ReachWatch::Silences& silences, std::vector<Product>& products) const;
  /// Reports, once per kind, samples for which the mission has no sensor.
  void tell_undescribed(const TelemetrySamples& samples, std::vector<Product>& products);

 private:
  std::string spacecraft_id_;
  SpacecraftKind spacecraft_kind_;
  std::set<std::string> tables_;  ///< Names of the tables in the mission file.
  bool told_both_ = false;
  std::array<bool, kTelemetryKindCount> told_undescribed_{};
};

}  // namespace spindrift
