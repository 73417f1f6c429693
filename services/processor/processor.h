/// @file
/// The one path of data: samples of all spacecraft in, batches for the archive out. Live, offline
/// and in replay only the source of the samples differs.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/last_run.h"
#include "services/archive/records.h"
#include "services/mission/mission.h"
#include "services/processor/spacecraft_run.h"
#include "services/processor/spin_run.h"
#include "services/processor/three_axis_run.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Samples as they came in, for the archive, and the work that they are for the pipelines.
struct Routed {
  std::vector<ArchiveBatch> samples;
  std::vector<PassInput> work;
};

/// What a restarted service goes on with.
struct GoneOn {
  Routed routed;
  LastOrigins last_origins;  ///< Of all the samples in it; a session may stand there twice.
  /// By spacecraft, where none goes on: what is known last, until the next run begins.
  std::map<std::string, LastRun> last_runs = {};
};

/// Has two sides, each for one thread: `route` takes samples in, `compute` works on them. The
/// batches of `route` go to the archive before its work is computed. The other calls need both
/// sides at rest.
class Processor {
 public:
  /// @return InvalidConfiguration with every mission that is the second of one spacecraft.
  static Expected<Processor> make(const std::vector<Mission>& missions,
                                  const TelemetrySource& source);

  /// Before either of the two below: whatever the wall clock says, what a new run takes arrives
  /// later than all that `archive` holds of its spacecraft. @return the error of reading it.
  Expected<void> arrive_after(const std::filesystem::path& archive);

  std::vector<ArchiveBatch> begin();

  /// In place of `begin`: goes on with those runs that `archive` holds. Of the other spacecraft the
  /// first run begins now, and a later one with its first sample or action, so that until then the
  /// run before it is the last. Its
  /// batches are committed before the next of `route` are submitted; its work comes first.
  /// @return the error of reading the archive.
  Expected<GoneOn> go_on(const std::filesystem::path& archive, const Moment& moment = {});

  /// What belongs to no spacecraft, rejected inputs and the counts of the sources, is stored under
  /// the first run only, so that sums over runs hold. A sample of a spacecraft without a mission
  /// here is another service's: it is counted and not stored.
  Routed route(SampleBatch samples, const Moment& moment = {});

  /// The streams of these spacecraft, which have missions here, gave nothing for so long that what
  /// is held is to be computed. As `route`, on its thread.
  /// That nothing comes may also tell whose time is right.
  Routed fall_silent(const std::vector<std::string>& spacecraft, const Moment& moment = {});

  /// When that nothing comes may tell whose time is right. Empty: not for now.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const;
  /// Of all spacecraft. On the thread of `route`.
  std::vector<SourceProblem> source_problems() const;

  std::vector<ArchiveBatch> compute(const PassInput& work);

  /// What became due in the last `compute` of that work.
  std::vector<BackgroundTask> take_background_tasks(const PassInput& work);

  /// Both, for those who have one thread.
  std::vector<ArchiveBatch> take(SampleBatch samples);

  std::vector<ArchiveBatch> finish();
  /// One of them. @param spacecraft As PassInput::spacecraft.
  std::vector<ArchiveBatch> finish(std::size_t spacecraft);

  bool is_live() const;

  /// Those with a mission here.
  std::vector<std::string> spacecraft() const;

  /// Spacecraft by spacecraft, all runs of each.
  std::vector<RunSummary> summaries() const;

  /// Samples of spacecraft without a mission here; beyond 256 of them together, under "(others)".
  const OtherSpacecraft& other_spacecraft() const { return other_spacecraft_; }

 private:
  Processor() = default;

  template <class Value>
  void distribute(SamplesOfKind<Value>& samples, std::map<std::size_t, SampleBatch>& by_run);
  void go_on(std::size_t i, const std::vector<StoredPass>& stored, const Moment& moment,
             GoneOn& gone_on);
  void begin_behind(std::size_t i, LastRun last, GoneOn& gone_on);
  void count_other(const std::string& spacecraft, std::int64_t samples);

  std::unordered_map<std::string, std::size_t> index_of_;  ///< Of a spacecraft, in both below.
  std::vector<SpacecraftRun> runs_;
  std::vector<std::variant<SpinRun, ThreeAxisRun>> passes_;  ///< By kind of spacecraft.
  OtherSpacecraft other_spacecraft_;
  std::vector<Product> told_of_others_;  ///< Not with a run yet.
};

}  // namespace spindrift
