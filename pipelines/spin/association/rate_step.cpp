#include "pipelines/spin/association/rate_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// The clock is doubted when kDoubtful of the last kRecent edges are not where it expects them.
constexpr std::size_t kRecent = 9;
constexpr std::ptrdiff_t kDoubtful = 4;
constexpr std::size_t kFewestAfterStep = 6;
// A comb with a shorter period than this part of the clock's is a faster body if nearly every turn
// has an edge. Otherwise the time stamps have stepped by a fraction of a turn.
constexpr double kMuchFaster = 0.75;
constexpr double kNearlyEvery = 0.8;
// Turns by which the whole comb may deviate from a whole multiple of the clock period.
constexpr double kSameTurns = 0.05;

bool is_fraction(const PulseTrain& comb, double period_s) {
  return comb.period_s < kMuchFaster * period_s &&
         static_cast<double>(comb.edges) < kNearlyEvery * (comb.turns + 1.0);
}

/// Tells whether the comb is the clock's own with edges on every second turn or fewer.
bool is_multiple(const PulseTrain& comb, double period_s) {
  const double clock_turns = comb.period_s / period_s;
  const double whole = std::round(clock_turns);
  return whole > 1.0 && std::abs(clock_turns - whole) * comb.turns < kSameTurns;
}

}  // namespace

void RateStepDetector::add(TaiTime t, bool good) {
  recent_.push_back({.t = t, .good = good});
  if (recent_.size() > kRecent) {
    recent_.pop_front();
  }
}

std::optional<PulseTrain> RateStepDetector::new_pulse_train(double noise_s, double period_s) const {
  const auto wrong = std::count_if(recent_.begin(), recent_.end(),
                                   [](const ReferenceEdge& edge) { return !edge.good; });
  if (wrong < kDoubtful || recent_.back().good) {
    return std::nullopt;
  }
  std::vector<TaiTime> edges(recent_.size());
  std::transform(recent_.begin(), recent_.end(), edges.begin(),
                 [](const ReferenceEdge& edge) { return edge.t; });
  auto comb = find_pulse_train(edges, noise_s, kFewestAfterStep);
  if (!comb || is_fraction(*comb, period_s) || is_multiple(*comb, period_s)) {
    return std::nullopt;
  }
  const auto on_comb = [&](const ReferenceEdge& edge) {
    const double t_s = elapsed_s(comb->t, edge.t);
    const double turns = t_s / comb->period_s + 0.5 * comb->drift_per_s2 * t_s * t_s;
    return std::abs(std::remainder(turns, 1.0)) * comb->period_s <= kOnComb_sigma * noise_s;
  };
  const auto on_it = std::count_if(recent_.begin(), recent_.end(), on_comb);
  const auto agreeing =
      std::count_if(recent_.begin(), recent_.end(),
                    [&](const ReferenceEdge& edge) { return edge.good && on_comb(edge); });
  // If half of the edges on the comb are good, it is the clock's own.
  const bool another = on_it >= static_cast<std::ptrdiff_t>(kFewestAfterStep) &&
                       2 * agreeing < on_it && on_comb(recent_.back());
  return another ? comb : std::nullopt;
}

}  // namespace spindrift
