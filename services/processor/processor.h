/// @file
/// The one path of data: samples of all spacecraft in, batches for the archive out. Live, offline
/// and replay differ only in the source of the samples.

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

/// Holds the received samples for the archive and the work for the pipelines that they give.
struct Routed {
  std::vector<ArchiveBatch> samples;
  std::vector<PassInput> work;
};

struct GoneOn {
  Routed routed;
  LastOrigins last_origins;  ///< Of all samples in `routed`; may list a session twice.
  /// By spacecraft that continues no run: its last run, until the next one begins.
  std::map<std::string, LastRun> last_runs = {};
};

/// Processes the telemetry of all spacecraft. It has two sides, each for one thread: `route` takes
/// samples in, `compute` works on them. The batches of `route` go to the archive before its work is
/// computed. The other calls need both sides at rest.
class Processor {
 public:
  /// @return InvalidConfiguration naming every mission whose spacecraft already has a mission.
  static Expected<Processor> make(const std::vector<Mission>& missions,
                                  const TelemetrySource& source);

  /// Makes new runs arrive later than all samples that `archive` holds of their spacecraft,
  /// whatever the wall clock says. To be called before `begin` or `go_on`.
  /// @return The error of reading the archive.
  Expected<void> arrive_after(const std::filesystem::path& archive);

  std::vector<ArchiveBatch> begin();

  /// Called instead of `begin`: continues the runs that `archive` holds. For a spacecraft without a
  /// stored run the first run begins now. When its last run cannot be continued, the new run begins
  /// with its first sample or action, so that until then the last run stays the newest. The
  /// returned batches must be committed before those of the next `route` are submitted, and the
  /// returned work comes before that of `route`. @return The error of reading the archive.
  Expected<GoneOn> go_on(const std::filesystem::path& archive, const Moment& moment = {});

  /// Sorts samples by spacecraft. Rejected inputs and the counts of the sources belong to no
  /// spacecraft and are stored under the first run only, so that sums over runs hold. A sample of a
  /// spacecraft without a mission here belongs to another service: it is counted and not stored.
  Routed route(SampleBatch samples, const Moment& moment = {});

  /// Notes that the streams of these spacecraft, which must have missions here, have been silent
  /// for so long that held samples are to be computed. The silence may also decide which source's
  /// time is right. To be called on the thread of `route`.
  Routed fall_silent(const std::vector<std::string>& spacecraft, const Moment& moment = {});

  /// Returns when a lack of samples may decide which source's time is right; empty when it cannot.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const;
  /// Returns the source problems of all spacecraft. To be called on the thread of `route`.
  std::vector<SourceProblem> source_problems() const;

  std::vector<ArchiveBatch> compute(const PassInput& work);

  /// Returns the tasks that became due in the last `compute` of that work.
  std::vector<BackgroundTask> take_background_tasks(const PassInput& work);

  /// Calls `route` and `compute`, for callers with one thread.
  std::vector<ArchiveBatch> process(SampleBatch samples);

  std::vector<ArchiveBatch> finish();
  /// Finishes one spacecraft's run. @param spacecraft Index as in PassInput::spacecraft.
  std::vector<ArchiveBatch> finish(std::size_t spacecraft);

  bool is_live() const;

  std::vector<std::string> spacecraft() const;

  std::vector<RunSummary> summaries() const;

  /// Returns counts of samples of spacecraft without a mission here. Beyond 256 such spacecraft
  /// they are counted together under "(others)".
  const OtherSpacecraft& other_spacecraft() const { return other_spacecraft_; }

 private:
  Processor() = default;

  template <class Value>
  void distribute(SamplesOfKind<Value>& samples, std::map<std::size_t, SampleBatch>& by_run);
  void go_on(std::size_t i, const std::vector<StoredPass>& stored, const Moment& moment,
             GoneOn& gone_on);
  void begin_behind(std::size_t i, LastRun last, GoneOn& gone_on);
  void count_other(const std::string& spacecraft, std::int64_t samples);

  /// Index of a spacecraft in `runs_` and `passes_`.
  std::unordered_map<std::string, std::size_t> index_of_;
  std::vector<SpacecraftRun> runs_;
  std::vector<std::variant<SpinRun, ThreeAxisRun>> passes_;
  OtherSpacecraft other_spacecraft_;
  std::vector<Product> told_of_others_;  ///< Notices not yet stored with a run.
};

}  // namespace spindrift
