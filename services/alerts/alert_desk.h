/// @file
/// Derives alerts from computed products, to be archived with the products they rest on.

#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/comparison/model_comparison.h"
#include "pipelines/supervision/alert_book.h"
#include "pipelines/supervision/attitude_conditions.h"
#include "pipelines/supervision/contradiction_conditions.h"
#include "pipelines/supervision/service_conditions.h"
#include "pipelines/supervision/spin_conditions.h"
#include "services/archive/records.h"
#include "services/mission/limits_in_force.h"
#include "services/mission/mission.h"

namespace spindrift {

class Archive;

struct OpenAlert {
  std::string spacecraft;
  Alert alert;
};

/// An operator's acknowledgement or shelving of an alert.
struct OperatorWord {
  std::string alert_id;
  std::string by;
  std::string note;
  int minutes = 0;  ///< Duration of shelving; 0 acknowledges.
  /// From then on somebody waits, also while other words are taken before.
  std::chrono::steady_clock::time_point said = std::chrono::steady_clock::now();
};

/// Safe to use from any thread.
class AlertDesk {
 public:
  /// @param mode Mode of its runs; it does not see runs of other programs through the archive.
  /// @param models Ground models of the spacecraft that are compared with one.
  AlertDesk(const std::vector<Mission>& missions, RunMode mode, const GroundModels& models = {});
  /// Supervises nothing: only alerts that are taken up can be changed.
  AlertDesk() = default;

  /// Returns the mode of the supervised runs.
  RunMode mode() const { return mode_; }

  /// Takes up an earlier alert from the archive; call it in the order of raising.
  void take_up(const std::string& spacecraft, const std::string& run_id, const Alert& alert);

  /// Counts an earlier transition of a spacecraft's alerts; call it in their order.
  void take_up_transition(const std::string& spacecraft, TaiTime t);

  /// Sets the last run of a spacecraft, which gets the service's alerts until the next run begins.
  void take_up_run(const std::string& spacecraft, const std::string& run_id);

  /// Computes the alerts that the samples and products of `batch` raise and clear, in the order of
  /// computing. They are added to `batch`, along with alerts taken back, or if it has samples to
  /// the next batch without any, since products would hold samples back.
  void evaluate(ArchiveBatch& batch);

  /// Adds to `batch`, if of the supervised run, the alerts that the changes raise and clear.
  void tell(const ConditionChanges& changes, ArchiveBatch& batch);

  /// Processes samples from before a restart, which do not come again. Call it after the batch that
  /// continues the run.
  void go_on(const std::string& spacecraft, const std::string& run_id, const PlacedValues& samples);

  /// Keeps the alerts of a batch that was not stored for the next batch.
  void take_back(const ArchiveBatch& batch);
  /// Notes the stored runs, since no alerts are returned for a run that is not stored.
  void note_stored(std::span<const ArchiveBatch> batches);

  /// Computes alerts of the service itself, and those whose shelving is over.
  /// @param states By spacecraft, of those with telemetry. @param now Wall clock.
  /// @return The batches to store.
  std::vector<ArchiveBatch> evaluate(const std::map<std::string, ServiceState>& states,
                                     TaiTime now);

  /// Returns the spacecraft's current run if it is stored, before that the one taken up; empty when
  /// there is none yet.
  std::string run_of(const std::string& spacecraft) const;

  /// Returns the target of the axis now; empty when none was set or it is no spinner.
  std::optional<SpinTarget> target_of(const std::string& spacecraft) const;

  /// Returns the open alerts of all spacecraft.
  std::vector<OpenAlert> open() const;

  /// Acknowledges or shelves an alert. @return The batch to store; InvalidInput when no such alert
  /// is open or it is in that state already.
  Expected<ArchiveBatch> obey(const OperatorWord& word, TaiTime now);

 private:
  using Conditions = std::variant<SpinConditions, AttitudeConditions>;
  // NOLINTNEXTLINE(bugprone-exception-escape): its variant always holds a value.
  struct Supervised {
    Mission mission;
    std::shared_ptr<const GroundModel> model;  ///< Null when there is no model.
    Conditions conditions;
    ContradictionConditions contradictions;
    std::optional<ModelComparison> comparison;
    ServiceConditions service;
    LimitsInForce limits;
    const AlertLimits* in_force = nullptr;  ///< Those that `conditions` have; null before any.
    std::string run_id = {};                ///< Supervised run, empty before the first.
    /// Answers of the run before, whose last solution comes while this one goes on.
    std::optional<SpinConditions> ended = {};
    std::string ended_run = {};
    std::string stored_run = {};  ///< Latest stored run, empty before the first.
  };
  struct Desk {
    std::optional<Supervised> supervised = {};
    AlertBook book = {};
    std::vector<Alert> waiting = {};                 ///< Changes not yet in any batch.
    std::map<std::string, std::string> run_of = {};  ///< Run by open alert.
  };

  static Conditions conditions_of(const Mission& mission);
  static void begin(Desk& desk);
  static void end(Supervised& supervised);
  static void apply(const OperatorAction& action, Supervised& supervised);
  static void put_limits_in_force(TaiTime t, Supervised& supervised);
  template <class Samples>
  static ConditionChanges changes_by(const Samples& samples, Supervised& supervised);
  static std::vector<Alert> changed_by(ArchiveBatch& batch, Desk& desk);
  static std::vector<Alert> changed_by(const ServiceState& state, Desk& desk);
  static std::vector<Alert> ended_by(ArchiveBatch& batch, Desk& desk);
  static std::vector<Alert> settled(const ConditionChanges& changes, const std::string& run_id,
                                    Desk& desk);

  RunMode mode_ = RunMode::Process;
  mutable std::mutex mutex_;
  std::map<std::string, Desk> desks_;  ///< Desks by spacecraft.
};

/// Applies an operator's word to an alert of `desk` from now on. @return What was stored and
/// announced; InvalidInput for a name or note that is no plain text; the errors of AlertDesk::obey;
/// Unavailable when it is in force but not stored within 5 s after it was said.
Expected<ArchiveBatch> take_word(const OperatorWord& word, AlertDesk& desk, Archive& archive);

}  // namespace spindrift
