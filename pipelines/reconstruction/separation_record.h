/// @file
/// The samples of a pass that its separation is reconstructed from, as they arrive, and when.

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

/// A solution is due at the first star fix behind T3 and whenever twice as many as at the last have
/// arrived: all together cost a few times the last; and when the stream falls silent behind others
/// that a solution uses. While no T3 is found, those behind T2 count. A fix ahead of the gyro
/// samples waits for them.
class SeparationRecord {
 public:
  /// Samples from T1 to so long behind it are kept.
  static constexpr std::chrono::hours kLongest{24};

  /// @param begun Without samples.
  explicit SeparationRecord(ReconstructionRequest begun) : request_{std::move(begun)} {}

  // Of those of one kind and instant one counts, or none (one_that_counts), whenever they come.
  // Each: @return whether a solution is due.
  bool push(const GyroSample& sample);
  bool push(const SunDirection& sun);
  bool push(const StarFix& fix);
  bool push(const TimedOrbitState& state);

  /// Perhaps nothing comes any more. @param apart Of telemetry, from one that was due in a silence
  /// to the next. @return whether a solution is due.
  bool fall_silent(std::chrono::nanoseconds apart);

  /// What an operator has left out since it arrived.
  /// @return whether a solution rests on it: another one is due.
  bool forget(const Exclusions<SampleKind>& excluded);

  /// What arrived has changed what counts of that before it, by a contradiction, and a solution
  /// rests on that. One that is not due yet is with the next silence.
  /// @param apart Of telemetry, from one that was due for this to the next. @return whether a
  /// solution is due.
  bool take_correction(std::chrono::nanoseconds apart);

  /// All up to now, each kind in order of time.
  const ReconstructionRequest& request() const { return request_; }

 private:
  template <class Sample>
  bool insert(std::vector<Sample>& samples, const Sample& sample);
  template <class Sample>
  void contest(std::vector<Sample>& samples, const Sample& sample);
  /// @param reached Gyro samples are there up to then. @return whether that was waited for.
  bool is_due(TaiTime reached);

  template <class Sample>
  using Said = std::map<TaiTime, std::vector<Sample>>;

  ReconstructionRequest request_;
  /// Of instants of which more than one thing was said.
  std::tuple<Said<GyroSample>, Said<SunDirection>, Said<StarFix>, Said<TimedOrbitState>> said_;
  std::optional<TaiTime> corrected_;        ///< The newest instant that a solution has wrong.
  std::optional<TaiTime> last_correction_;  ///< Likewise, when one was due for it.
  bool has_acquisition_ = false;            ///< T3 was there at the last star fix.
  std::int64_t fixes_ = 0;                  ///< That have arrived behind it.
  std::int64_t due_at_fixes_ = 1;
  std::optional<TaiTime> awaited_;       ///< A solution is due once gyro samples reach it.
  bool was_due_ = false;                 ///< A solution.
  std::optional<TaiTime> used_until_;    ///< The end of what a solution uses, at the last star fix.
  std::optional<TaiTime> newest_used_;   ///< Of what arrived since a solution was due.
  std::optional<TaiTime> last_silence_;  ///< That newest one, when one was due in a silence.
};

}  // namespace spindrift
