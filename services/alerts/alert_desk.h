/// @file
/// Supervises what a program computes: alerts go to the archive with the products they rest on.

#pragma once

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
#include "services/mission/mission.h"

namespace spindrift {

struct OpenAlert {
  std::string spacecraft;
  Alert alert;
};

/// Used by any thread.
class AlertDesk {
 public:
  /// @param mode Of the runs it sees: those of other programs through the same archive it does not.
  /// @param models Of the spacecraft that are held against one.
  AlertDesk(const std::vector<Mission>& missions, RunMode mode, const GroundModels& models = {});
  /// Supervises nothing: alerts that are taken up may be changed.
  AlertDesk() = default;

  /// Of the runs it sees.
  RunMode mode() const { return mode_; }

  /// An alert of before, as the archive has it, in the order in which they were raised.
  void take_up(const std::string& spacecraft, const std::string& run_id, const Alert& alert);

  /// The last run of a spacecraft, until the next begins: alerts of the service stand with it.
  void take_up_run(const std::string& spacecraft, const std::string& run_id);

  /// Of the samples and products of `batch` the alerts that they raise and clear, in the order of
  /// computing. They are added to it or, since products would hold samples back, to the next batch
  /// without samples; as what was taken back is.
  void see(ArchiveBatch& batch);

  /// Adds to `batch`, of the run that it sees, the alerts that these changes raise and clear.
  void tell(const ConditionChanges& changes, ArchiveBatch& batch);

  /// Samples of before a restart, which do not come again. After the batch that says that the run
  /// goes on.
  void go_on(const std::string& spacecraft, const std::string& run_id,
             const TelemetryValues& samples);

  /// What was added to a batch, or given for one, that is not stored now: of the next one again.
  void take_back(const ArchiveBatch& batch);
  /// Runs that have begun: nothing is given for a run that is not stored.
  void note_stored(std::span<const ArchiveBatch> batches);

  /// Alerts that the service itself raises and clears, and those whose shelving is over.
  /// @param states Of the spacecraft of which telemetry has come. @param now Wall clock.
  /// @return what is to be stored.
  std::vector<ArchiveBatch> see(const std::map<std::string, ServiceState>& states, TaiTime now);

  /// The run of a spacecraft that is computed now, as far as the archive holds it; before it the
  /// one that was taken up. Empty: none yet.
  std::string run_of(const std::string& spacecraft) const;

  /// Where the axis should be now; empty: nobody has said, or it is no spinner.
  std::optional<SpinTarget> target_of(const std::string& spacecraft) const;

  /// Of all spacecraft.
  std::vector<OpenAlert> open() const;

  /// @return what is to be stored; InvalidInput where no such alert is open.
  Expected<ArchiveBatch> acknowledge(const std::string& alert_id, TaiTime now,
                                     const std::string& by, const std::string& note);
  Expected<ArchiveBatch> shelve(const std::string& alert_id, TaiTime now, TaiTime until,
                                const std::string& by, const std::string& note);

 private:
  using Conditions = std::variant<SpinConditions, AttitudeConditions>;
  // NOLINTNEXTLINE(bugprone-exception-escape): its variant always holds a value.
  struct Supervised {
    Mission mission;
    std::shared_ptr<const GroundModel> model;  ///< Null: there is none.
    Conditions conditions;
    ContradictionConditions contradictions;
    std::optional<ModelComparison> comparison;
    ServiceConditions service;
    std::string run_id = {};      ///< Empty: none yet.
    std::string stored_run = {};  ///< Likewise; the last that the archive holds.
  };
  struct Desk {
    std::optional<Supervised> supervised = {};
    AlertBook book = {};
    std::vector<Alert> waiting = {};  ///< Changes that are in the book and in no batch.
    std::map<std::string, std::string> run_of =
        {};  ///< By open alert, of those taken up and raised.
  };

  static Conditions conditions_of(const Mission& mission);
  static void begin(Supervised& supervised);
  template <class Samples>
  static ConditionChanges changes_by(const Samples& samples, Supervised& supervised);
  static std::vector<Alert> changed_by(const ArchiveBatch& batch, Desk& desk);
  static std::vector<Alert> changed_by(const ServiceState& state, Desk& desk);
  static std::vector<Alert> settled(const ConditionChanges& changes, Desk& desk);
  template <class Do>
  Expected<ArchiveBatch> with_alert(const std::string& alert_id, const Do& act);

  RunMode mode_ = RunMode::Process;
  mutable std::mutex mutex_;
  std::map<std::string, Desk> desks_;  ///< By spacecraft.
};

}  // namespace spindrift
