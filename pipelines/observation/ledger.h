/// @file
/// The observations of one estimator, as far as anybody asks for them later: what monitors,
/// assessments and alerts say of its measurements are queries of this.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/observation/observation.h"
#include "pipelines/observation/observation_record.h"
#include "pipelines/observation/oscillation.h"
#include "pipelines/statistics/recent_mean.h"

namespace spindrift {

/// What people are shown is of the last few hundred observations of each source.
inline constexpr RecordRules kShownRules{
    .recent = 300.0, .fewest_freedoms = 15.0, .most_freedoms = 300.0, .noise_from_share = 1.0};

/// What people are shown of one source.
struct SourceSummary {
  SampleSource source;
  double used;                  ///< Share.
  std::optional<double> noise;  ///< ObservationRecord::noise(); empty: none was used.
};

class Ledger {
 public:
  explicit Ledger(const RecordRules& rules)
      : all_{rules}, of_(kSampleSources, Source{.record = ObservationRecord{rules}}) {}

  /// @param together Of one instant, or of one turn of the body: in that each source speaks once.
  void add(std::span<const Observation> together);

  const ObservationRecord& all() const { return all_; }
  const ObservationRecord& of(SampleSource source) const { return at(source).record; }
  double oscillation(SampleSource source) const { return at(source).oscillation.noise(); }

  /// The source that is left out in the most of the recent turns, where that is more than half.
  std::optional<SampleSource> mostly_left_out() const;
  /// Every source that has spoken.
  std::vector<SourceSummary> sources() const;
  std::int64_t turns() const { return turns_; }

  /// The estimator begins anew: as ObservationRecord.
  void restart();
  void discard_transient(double most);

 private:
  static constexpr double kRecentTurns = 10.0;

  struct Source {
    ObservationRecord record;
    Oscillation oscillation = {};
    RecentMean turns_left_out{kRecentTurns};
  };
  const Source& at(SampleSource source) const { return of_[index_of(source)]; }

  ObservationRecord all_;
  std::vector<Source> of_;  ///< Each stands at the index of its SampleSource.
  std::int64_t turns_ = 0;
};

}  // namespace spindrift
