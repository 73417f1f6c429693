/// @file
/// What the console shows of one spacecraft.

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
#include "services/mission/mission.h"
#include "services/products/products.h"
#include "services/publisher/health.h"

namespace spindrift {

class ShownSpacecraft {
 public:
  /// @param mission Outlives it.
  explicit ShownSpacecraft(const Mission& mission);

  /// What was shown of another run is forgotten.
  void show(const std::string& run_id);
  const std::string& run_id() const { return run_id_; }

  /// @name Products of the run
  /// @return as viewers are told, for some with what else is known of it.
  /// @{
  nlohmann::json take(const SpinEstimate& estimate);
  nlohmann::json take(const SpinFix& fix);
  nlohmann::json take(const AttitudeEstimate& attitude);
  void take(const ReconstructionProduct& separation);
  /// @}
  void take_details(const ArchiveBatch& stored);

  void take(const SpacecraftHealth& health) { health_ = health; }
  /// Of the run.
  void take(const PassVerdict& verdict) { verdict_ = verdict; }
  void take(const SpinTarget& target) { target_ = target; }

  /// As in /api/v1/state, but whether it is go.
  nlohmann::json state();
  /// But for its alerts.
  Standing standing() const;
  const AlertLimits& limits() const { return mission_.alerts; }
  /// Edges since the last time, with their spin phase where that is known.
  nlohmann::json take_pulses();

 private:
  void take(const OperatorAction& action);
  void note(const SpinMeasurement& measurement);
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
  std::map<TaiTime, double> periods_s_;  ///< Of the last turns, by their sun1.
  std::deque<PulseUse> edges_;           ///< That viewers were not told yet.
  /// The last measurements that failed their test.
  std::map<std::pair<std::int64_t, SpinQuantity>, SpinMeasurement> failed_;
  Ledger ledger_;  ///< Of what edges said to `sequential`, or samples to the filter.
  std::deque<OperatorAction> actions_;                   ///< The last ones.
  std::map<TaiTime, SpinPrior> priors_;                  ///< Set by actions: each from then on.
  std::optional<std::pair<TaiTime, double>> bound_deg_;  ///< Of the last batch solution.
  ApparentSun sun_;
};

}  // namespace spindrift
