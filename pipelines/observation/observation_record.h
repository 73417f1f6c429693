/// @file
/// The record of what the observations of one source, or of several together, say of its noise
/// and of how many are left out.

#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "pipelines/observation/observation.h"
#include "pipelines/statistics/recent_mean.h"

namespace spindrift {

/// Over how many observations a record is kept.
struct RecordRules {
  double recent;           ///< So many make the share of what is left out.
  double fewest_freedoms;  ///< Fewer say nothing of the noise.
  double most_freedoms;    ///< So many of the last ones do.
  /// From this share on what is left out belongs to the noise, and is not spurious.
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

  /// @param together Of one turn or instant: first their shares, then the noise.
  void add(std::span<const Observation> together);

  /// Of the recent ones, as if all had been used before the first.
  double recent_share_left_out() const { return recent_share_.mean(); }
  /// Likewise, but of the first ones the plain share: what starts wrong says so at once.
  double share_left_out() const { return share_from_the_start_.mean(); }
  /// How many were heard, no more than recent ones.
  double heard() const { return share_from_the_start_.count(); }
  std::int64_t left_out() const { return left_out_; }

  /// Root of the mean square of a residual in its sigmas, of what was used: 1 when all is well.
  double noise() const { return std::sqrt(mean_square_.mean()); }
  /// How many times the variance of a residual is what its sigma makes it, where that is
  /// significantly more than 1 (variance_factor.h); else 1.
  double excess_noise() const;

  /// The estimator begins anew: so do the shares. The noise stays what it is, but less sure.
  void restart();
  /// The noise so far was a transient: no more than `most` of it is believed.
  void discard_transient(double most);

 private:
  RecordRules rules_;
  RecentMean recent_share_;
  RecentMean share_from_the_start_;
  RecentMean share_for_noise_;
  RecentMean mean_square_;  ///< Of one freedom.
  std::int64_t left_out_ = 0;
};

}  // namespace spindrift
