/// @file
/// Whether flight leaves the band about the model, and stays outside.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/ground_model/comparison/compared_sample.h"
#include "pipelines/ground_model/comparison/residual_statistics.h"
#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// What came of a channel.
struct ChannelComparison {
  ComparedChannel channel;
  ResidualStatistics residuals = {};
  std::int64_t outside = 0;  ///< Residuals that are not within the band.
  /// Since when flight is away, the first time that it stayed away; value, limit and unit are of
  /// that instant: the size of the residual and the half-width of its band, or, in "s silent", how
  /// long nothing had come when that was clear.
  std::optional<Evidence> departure = {};
};

/// A channel departs that is outside the band, or is silent where the model sends, at every sample
/// for as long as it holds (ConditionWatch) and at kLeastSamples; behind a gap that is longer it is
/// looked at anew. It is back when it is within 0.8 of the band as long.
class DepartureWatch {
 public:
  static constexpr int kLeastSamples = 5;

  /// @param band_sigmas Half-width of the band, in sigma of each residual.
  DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas);

  /// What is earlier than a sample of its channel before counts for the statistics only.
  std::optional<ConditionChange> see(const ComparedSample& sample);

  /// In the order of the channels.
  std::vector<ChannelComparison> channels() const;

 private:
  struct Watched {
    ChannelComparison comparison;
    ConditionWatch watch;
    std::optional<TaiTime> last = {};
    std::optional<Evidence> leaving = {};  ///< Since it is away; empty: it is not.
    int away = 0;                          ///< Samples since then.
  };
  static void begin_anew(TaiTime t, Watched& watched);
  std::optional<ConditionChange> judge(const ComparedSample& sample, bool is_away,
                                       Watched& watched) const;

  double band_sigmas_;
  std::vector<Watched> watched_;
};

}  // namespace spindrift
