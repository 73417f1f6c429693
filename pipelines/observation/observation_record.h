/// @file
/// The noise and the rejection rate of the observations of one source, or of several together.

#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "pipelines/observation/observation.h"
#include "pipelines/statistics/recent_mean.h"

namespace spindrift {

/// Sets over how many observations the statistics extend.
struct RecordRules {
  double recent;           ///< Window of the share of rejections.
  double fewest_freedoms;  ///< Degrees of freedom below which the noise counts as unknown.
  double most_freedoms;    ///< Window of the noise, in degrees of freedom.
  /// Share of rejections above which rejected observations count as noise, not as spurious.
  double noise_from_share;
};

class ObservationRecord {
 public:
  explicit ObservationRecord(const RecordRules& rules)
      : rules_{rules},
        recent_share_{rules.recent, rules.recent},
        share_from_the_start_{rules.recent},
        share_for_noise_{rules.most_freedoms},
        mean_square_{rules.most_freedoms} {}

  /// @param together Observations of one revolution or instant; shares are updated before the
  ///         noise.
  void add(std::span<const Observation> together);

  /// Returns the recent share of rejections, starting from a full window without rejections.
  double recent_share_left_out() const { return recent_share_.mean(); }
  /// Returns the recent share of rejections, starting empty so that an early fault shows at once.
  double share_left_out() const { return share_from_the_start_.mean(); }
  /// Returns the number of observations, at most the window `recent`.
  double heard() const { return share_from_the_start_.count(); }
  std::int64_t left_out() const { return left_out_; }

  /// Returns the root mean square of the whitened residuals used; 1 for noise as stated.
  double noise() const { return std::sqrt(mean_square_.mean()); }
  /// Returns actual over stated variance if significantly above 1 (significance.h); else 1.
  double excess_noise() const;

  /// Restarts the shares with the estimator. The noise keeps its value but loses weight.
  void restart();
  /// Reduces the weight of a noise that was a transient, and caps its mean square at `most`.
  void discard_transient(double most);

 private:
  RecordRules rules_;
  RecentMean recent_share_;
  RecentMean share_from_the_start_;
  RecentMean share_for_noise_;
  RecentMean mean_square_;  ///< Mean square per degree of freedom.
  std::int64_t left_out_ = 0;
};

}  // namespace spindrift
