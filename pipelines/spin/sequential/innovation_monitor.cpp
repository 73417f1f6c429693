#include "pipelines/spin/sequential/innovation_monitor.h"

#include <algorithm>

#include "pipelines/statistics/variance_factor.h"

namespace spindrift {
namespace {

// Of so many edges the mean squared innovation, 1 when all is well, says whether the noise is as
// stated: chi-square of one degree of freedom each.
constexpr double kFitEdges = 300.0;
constexpr double kFewestEdges = 15.0;
// Still significant for the fewest edges, and soon no more where the following ones are good.
constexpr double kMostOfStart = 4.0;
// From this share on the gated edges belong to the noise, and are not spurious.
constexpr double kManyGated = 0.2;
// What they said of the model before a restart weighs as much as so many edges.
constexpr double kFadedEdges = 100.0;

}  // namespace

void InnovationMonitor::note(const EdgeStatistics& tally) {
  const auto accepted = static_cast<double>(tally.accepted.count());
  const auto gated = static_cast<double>(tally.gated.count());
  if (accepted + gated == 0.0) {
    return;
  }
  edges_ = std::min(edges_ + accepted + gated, kFitEdges);
  gated_share_ += (gated - (accepted + gated) * gated_share_) / edges_;
  const bool with_gated = gated_share_ > kManyGated;
  const double counted = accepted + (with_gated ? gated : 0.0);
  const double squares = tally.squared_innovations - (with_gated ? 0.0 : tally.squared_gates);
  squared_innovation_ += (squares - counted * squared_innovation_) / edges_;
  error_edges_ += accepted;
  errors_ += tally.errors;
}

void InnovationMonitor::fade() {
  edges_ = std::min(edges_, kFewestEdges);
  const double share = error_edges_ > kFadedEdges ? kFadedEdges / error_edges_ : 1.0;
  error_edges_ *= share;
  errors_ *= share;
}

void InnovationMonitor::discard_transient() {
  fade();
  squared_innovation_ = std::min(squared_innovation_, kMostOfStart);
  error_edges_ = 0.0;
  errors_ = {};
}

double InnovationMonitor::excess_noise() const {
  return edges_ >= kFewestEdges ? variance_factor(squared_innovation_, edges_) : 1.0;
}

}  // namespace spindrift
