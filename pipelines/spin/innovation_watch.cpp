#include "pipelines/spin/innovation_watch.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Of so many edges the mean squared innovation, 1 when all is well, says whether the noise is as
// stated: chi-square of one degree of freedom each, beyond so many of its sigmas.
constexpr double kFitEdges = 300.0;
constexpr double kFewestEdges = 15.0;
constexpr double kFitSigmas = 5.0;
// Still significant for the fewest edges, and soon no more where the following ones are good.
constexpr double kMostOfStart = 4.0;
// From this share on the gated edges belong to the noise, and are not spurious.
constexpr double kManyGated = 0.2;
// Of a channel's last edges; their mean is 0 within so many of its sigmas when all is well.
constexpr double kMeanEdges = 1000.0;
constexpr double kFewestOfChannel = 20.0;
constexpr double kMeanSigmas = 5.0;

}  // namespace

void InnovationWatch::note(const EdgeTally& tally) {
  const auto accepted = static_cast<double>(tally.accepted.count());
  const auto gated = static_cast<double>(tally.gated.count());
  if (accepted + gated == 0.0) {
    return;
  }
  edges_ = std::min(edges_ + accepted + gated, kFitEdges);
  gated_share_ += (gated - (accepted + gated) * gated_share_) / edges_;
  const bool with_gated = gated_share_ > kManyGated;
  const double counted = accepted + (with_gated ? gated : 0.0);
  const double squares =
      tally.squared_innovations - (with_gated ? 0.0 : tally.squared_gate * gated);
  squared_innovation_ += (squares - counted * squared_innovation_) / edges_;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    if (tally.accepted.test(channel)) {
      double& edges = channel_edges_.at(channel);
      edges = std::min(edges + 1.0, kMeanEdges);
      const auto row = static_cast<Eigen::Index>(channel);
      mean_innovation_[row] += (tally.innovations.at(channel) - mean_innovation_[row]) / edges;
      mean_of_errors_.row(row) +=
          (tally.innovation_of_errors.row(row) - mean_of_errors_.row(row)) / edges;
    }
  }
}

void InnovationWatch::fade() {
  edges_ = std::min(edges_, kFewestEdges);
  for (double& edges : channel_edges_) {
    edges = std::min(edges, kFewestOfChannel);
  }
}

void InnovationWatch::forget_the_start() {
  fade();
  squared_innovation_ = std::min(squared_innovation_, kMostOfStart);
}

double InnovationWatch::excess_noise() const {
  const bool significant =
      edges_ >= kFewestEdges && squared_innovation_ > 1.0 + kFitSigmas * std::sqrt(2.0 / edges_);
  return significant ? squared_innovation_ : 1.0;
}

std::optional<PulseChannel> InnovationWatch::biased_channel() const {
  const double noise = std::sqrt(std::max(1.0, squared_innovation_));
  std::optional<PulseChannel> worst;
  double most = kMeanSigmas;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const double edges = channel_edges_.at(channel);
    const double sigmas =
        std::abs(mean_innovation_[static_cast<Eigen::Index>(channel)]) * std::sqrt(edges) / noise;
    if (edges >= kFewestOfChannel && sigmas > most) {
      worst = static_cast<PulseChannel>(channel);
      most = sigmas;
    }
  }
  return worst;
}

double InnovationWatch::channel_error_rad() const {
  return biased_channel() ? mean_innovation_.norm() / mean_of_errors_.norm() : 0.0;
}

}  // namespace spindrift
