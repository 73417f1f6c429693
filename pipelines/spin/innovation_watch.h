/// @file
/// Whether the edges are what the filter takes them for: normalised innovations of variance 1 and
/// mean 0, of every channel.
///
/// More variance is more noise than stated. A mean is an error of the model (a slit or a beam that
/// is not where the mission says, the limb): what the axis can take up of it moves the axis and is
/// not seen, the rest stays in the innovations for ever. With A what a constant error b of the
/// channels adds to the innovations, and m their means,
///
///     m = A b        and, all channels alike,        sigma_b^2 = |m|^2 / |A|^2
///
/// so that what is seen says how large the part is that is not.

#pragma once

#include <array>
#include <optional>

#include "pipelines/spin/pulse.h"
#include "pipelines/spin/spin_filter.h"

namespace spindrift {

class InnovationWatch {
 public:
  void note(const EdgeTally& tally);

  /// What was seen so far shall weigh little beside what comes: a filter begins anew.
  void fade();

  /// The filter has come from its start to where its edges fit: what that took is no noise.
  void forget_the_start();

  /// How many times the variance of the edges is what their stated noise makes it, where that is
  /// significantly more than 1; else 1.
  double excess_noise() const;

  /// The channel whose edges come early or late by most, where one does so significantly.
  std::optional<PulseChannel> biased_channel() const;

  /// One standard deviation of the constant error of a channel's phases that the means suggest,
  /// rad; 0 without a biased channel.
  double channel_error_rad() const;

 private:
  using PerChannel = Eigen::Matrix<double, kPulseChannels, 1>;

  double edges_ = 0.0;  ///< So many speak in the following two.
  double squared_innovation_ = 1.0;
  double gated_share_ = 0.0;
  std::array<double, kPulseChannels> channel_edges_ = {};  ///< Likewise, by channel.
  PerChannel mean_innovation_ = PerChannel::Zero();
  Eigen::Matrix<double, kPulseChannels, kPulseChannels> mean_of_errors_ =
      Eigen::Matrix<double, kPulseChannels, kPulseChannels>::Zero();
};

}  // namespace spindrift
