/// @file
/// Detects flight that leaves the band about the model and stays outside.

#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "pipelines/ground_model/comparison/compared_sample.h"
#include "pipelines/ground_model/comparison/residual_statistics.h"
#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Holds the result of the comparison in one channel.
struct ChannelComparison {
  ComparedChannel channel;
  ResidualStatistics residuals = {};
  std::int64_t outside = 0;  ///< Number of residuals outside the band.
  /// First departure of flight that lasted. Its value, limit and unit are of its first instant: the
  /// size of the residual and the half-width of its band or, in "s silent", the length of the
  /// silence.
  std::optional<Evidence> departure = {};
};

/// Watches for departures. A channel of values departs once, among its samples of the last
/// `holding_s`, those that are outside the band or missing outnumber the others by kAhead; it is
/// back when at most a quarter has been so for kClear_s. So flight that oscillates about the model
/// departs; outliers do not. A sensor departs that sends nothing for `holding_s` while the model
/// sends.
class DepartureWatch {
 public:
  static constexpr int kAhead = 8;
  static constexpr double kClear_s = 60.0;

  /// @param band_sigmas Half-width of the band, in sigma of each residual.
  DepartureWatch(const std::vector<ComparedChannel>& channels, double band_sigmas);

  /// Judges a sample; one earlier than its channel's last sample counts for the statistics only.
  std::optional<ConditionChange> see(const ComparedSample& sample);

  /// Returns the results in the order of the channels given to the constructor.
  std::vector<ChannelComparison> channels() const;

 private:
  struct Judged {
    bool is_away;
    Evidence evidence;
  };
  struct Watched {
    ChannelComparison comparison;
    ConditionWatch watch;
    /// Last samples; of a silent sensor the first and the last only.
    std::deque<Judged> window = {};
  };
  /// Returns empty where the channel counts neither as away nor as back.
  static std::optional<bool> is_away(const Judged& now, Watched& watched);
  static std::optional<bool> is_silent(const Judged& now, Watched& watched);

  double band_sigmas_;
  std::vector<Watched> watched_;
};

}  // namespace spindrift
