/// @file
/// The console's data on one spacecraft.

#pragma once

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/observation/ledger.h"
#include "services/archive/records.h"
#include "services/console/go_no_go.h"
#include "services/mission/limits_in_force.h"
#include "services/mission/mission.h"
#include "services/products/products.h"
#include "services/publisher/health.h"

namespace spindrift {

class ShownSpacecraft {
 public:
  /// @param mission Must outlive this object.
  explicit ShownSpacecraft(const Mission& mission);

  /// Switches to a run and clears what was shown of another run.
  void switch_to(const std::string& run_id);
  const std::string& run_id() const { return run_id_; }

  /// @name Products of the run
  /// @return The JSON for viewers, for some products with further known data.
  /// @{
  nlohmann::json show(const SpinEstimate& estimate);
  nlohmann::json show(const SpinFix& fix);
  nlohmann::json show(const AttitudeEstimate& attitude);
  void show(const ReconstructionProduct& separation);
  /// @}
  void take_details(const ArchiveBatch& stored);

  void show(const SpacecraftHealth& health) { health_ = health; }
  /// Returns whether it differs from the verdict of before.
  bool show(const PassVerdict& verdict) {
    return std::exchange(verdict_, verdict) != std::optional{verdict};
  }
  void show(const SpinTarget& target) { target_ = target; }

  /// Returns the spacecraft's part of /api/v1/state, without the go/no-go decision.
  nlohmann::json state();
  /// Returns the standing without alerts.
  Standing standing() const;
  /// Returns the limits of alerts in force.
  const AlertLimits& limits();
  /// Returns the edges since the last call, with their spin phase where that is known.
  nlohmann::json take_pulses();

 private:
  void show(const OperatorAction& action);
  void show_effect(const RunNotice& notice);
  void remember(const SpinMeasurement& measurement);
  nlohmann::json held_against(const PulseUse& edge) const;
  nlohmann::json residuals() const;
  nlohmann::json prior() const;
  void add_sky(nlohmann::json& state);
  std::optional<double> to_target_deg() const;
  std::optional<double> phase_deg(TaiTime t) const;

  const Mission& mission_;
  std::optional<SpinTarget> target_;
  std::string run_id_;
  SpacecraftHealth health_;
  nlohmann::json answers_ = nlohmann::json::object();
  std::optional<PassVerdict> verdict_;
  std::map<TaiTime, double> periods_s_;  ///< Periods of the latest turns by sun1 time.
  std::deque<PulseUse> edges_;           ///< Edges not sent to viewers yet.
  /// Latest measurements that failed their test.
  std::map<std::pair<std::int64_t, SpinQuantity>, SpinMeasurement> failed_;
  Ledger ledger_;  ///< Residuals of edges in `sequential`, or of samples in the filter.
  std::deque<OperatorAction> actions_;          ///< The latest actions.
  std::map<std::string, std::string> effects_;  ///< What actions have done, by action_id.
  LimitsInForce limits_{mission_.alert_values, mission_.contact};
  std::map<TaiTime, SpinPrior> priors_;                  ///< Set by actions, by start time.
  std::optional<std::pair<TaiTime, double>> bound_deg_;  ///< From the last batch solution.
  ApparentSun sun_;
};

}  // namespace spindrift
