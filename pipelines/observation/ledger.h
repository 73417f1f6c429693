/// @file
/// The ledger of one estimator's observations, which monitors, assessments and alerts query.

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

/// Rules for display: the last few hundred observations of each source.
inline constexpr RecordRules kShownRules{
    .recent = 300.0, .fewest_freedoms = 15.0, .most_freedoms = 300.0, .noise_from_share = 1.0};

/// Holds the statistics of one source for display.
struct SourceSummary {
  SampleSource source;
  double used;                  ///< Share of observations used.
  std::optional<double> noise;  ///< ObservationRecord::noise(); empty if none was used.
};

class Ledger {
 public:
  explicit Ledger(const RecordRules& rules)
      : all_{rules}, of_(kSampleSources, Source{.record = ObservationRecord{rules}}) {}

  /// @param together Observations of one instant, or of one revolution with one per source.
  void add(std::span<const Observation> together);

  const ObservationRecord& all() const { return all_; }
  const ObservationRecord& of(SampleSource source) const { return at(source).record; }
  double oscillation(SampleSource source) const { return at(source).oscillation.noise(); }

  /// Returns the source rejected in the most recent revolutions, if in more than half of them.
  std::optional<SampleSource> mostly_left_out() const;
  /// Returns the statistics of every source with observations.
  std::vector<SourceSummary> sources() const;
  std::int64_t turns() const { return turns_; }

  /// Restarts the records with the estimator; see ObservationRecord.
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
  std::vector<Source> of_;  ///< Indexed by SampleSource.
  std::int64_t turns_ = 0;
};

}  // namespace spindrift
