/// @file
/// Whether flight leaves the band about the model, and stays outside.

#pragma once

#include <deque>
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

/// A channel of values departs once of its samples in the last `holding_s` those that are outside
/// the band, or do not come, outnumber the others by kAhead; it is back when at most a quarter has
/// been away for kClear_s. So flight that swings about the model departs, too, and outliers do not.
/// A sensor departs that sends nothing for `holding_s` where the model sends.
class DepartureWatch {
 public:
  static constexpr int kAhead = 8;
  static constexpr double kClear_s = 60.0;

  /// @param band_sigmas Half-width of the band, in sigma of each residual.
  DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas);

  /// What is earlier than a sample of its channel before counts for the statistics only.
  std::optional<ConditionChange> see(const ComparedSample& sample);

  /// In the order of the channels.
  std::vector<ChannelComparison> channels() const;

 private:
  struct Judged {
    bool is_away;
    Evidence evidence;
  };
  struct Watched {
    ChannelComparison comparison;
    ConditionWatch watch;
    std::deque<Judged> window = {};  ///< Of a sensor the first and the last since it is silent.
  };
  /// Empty: neither away nor back.
  static std::optional<bool> is_away(const Judged& now, Watched& watched);
  static std::optional<bool> is_silent(const Judged& now, Watched& watched);

  double band_sigmas_;
  std::vector<Watched> watched_;
};

}  // namespace spindrift
