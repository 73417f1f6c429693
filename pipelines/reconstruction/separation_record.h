/// @file
/// Collects the samples of a pass for its separation reconstruction and decides when to solve.

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// Holds the samples received. A solution is due at the first star fix after T3 and whenever the
/// number of fixes has doubled since the last one, so that all solutions together cost a few times
/// the last. It is also due when the stream falls silent after further usable samples. Until T3 is
/// found, fixes after T2 count. A fix later than the gyro samples waits for them.
class SeparationRecord {
 public:
  /// Time after T1 up to which samples are kept.
  static constexpr std::chrono::hours kLongest{24};

  /// @param begun Request without samples.
  explicit SeparationRecord(ReconstructionRequest begun) : request_{std::move(begun)} {}

  // Adds a sample. Of contradicting samples of one kind and instant at most one counts
  // (one_that_counts), in whatever order they arrive. @return True if a solution is due.
  bool push(const GyroSample& sample);
  bool push(const SunDirection& sun);
  bool push(const StarFix& fix);
  bool push(const TimedOrbitState& state);

  /// Handles a silence of the stream. @param apart Least span of telemetry time between two
  /// solutions that silences trigger. @return True if a solution is due.
  bool fall_silent(std::chrono::nanoseconds apart);

  /// Drops samples that an operator has excluded since they arrived.
  /// @return True if a solution used them, so that a new one is due.
  bool forget(const Exclusions<SampleKind>& excluded);

  /// Handles contradictions that changed which of the earlier samples count after a solution used
  /// them. A correction that is not due yet becomes due at the next silence.
  /// @param apart Least span of telemetry time between two corrections.
  /// @return True if a solution is due.
  bool take_correction(std::chrono::nanoseconds apart);

  /// Returns all samples up to now, each kind in time order.
  const ReconstructionRequest& request() const { return request_; }

 private:
  template <class Sample>
  bool insert(std::vector<Sample>& samples, const Sample& sample);
  template <class Sample>
  void contest(std::vector<Sample>& samples, const Sample& sample);
  /// @param reached Time up to which gyro samples exist. @return True if a solution awaited it.
  bool is_due(TaiTime reached);

  template <class Sample>
  using Said = std::map<TaiTime, std::vector<Sample>>;

  ReconstructionRequest request_;
  /// All contending samples of each instant that has several.
  std::tuple<Said<GyroSample>, Said<SunDirection>, Said<StarFix>, Said<TimedOrbitState>> said_;
  std::optional<TaiTime> corrected_;  ///< Newest instant whose sample changed after a solution.
  std::optional<TaiTime> last_correction_;  ///< Value of `corrected_` when it was last due.
  bool has_acquisition_ = false;            ///< True if T3 was known at the last star fix.
  std::int64_t fixes_ = 0;                  ///< Star fixes that arrived after T3.
  std::int64_t due_at_fixes_ = 1;
  std::optional<TaiTime> awaited_;       ///< Gyro time at which a solution becomes due.
  bool was_due_ = false;                 ///< True once any solution was due.
  std::optional<TaiTime> used_until_;    ///< End of what a solution uses, as of the last fix.
  std::optional<TaiTime> newest_used_;   ///< Newest usable sample since a solution was last due.
  std::optional<TaiTime> last_silence_;  ///< `newest_used_` when a silence was last due.
};

}  // namespace spindrift
