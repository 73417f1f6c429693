#include "pipelines/spin/rate_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pipelines/spin/clock_start.h"
#include "pipelines/spin/spin_clock.h"

namespace spindrift {
namespace {

// Of so many edges so many are wrong when it is time to ask whether the clock is.
constexpr std::size_t kRecent = 9;
constexpr std::ptrdiff_t kDoubtful = 4;
constexpr std::size_t kFewestAfterStep = 6;
// A body that turns so much faster than before has an edge on nearly every turn. Otherwise it turns
// as before, and the time stamps have stepped by a fraction of a turn.
constexpr double kMuchFaster = 0.75;
constexpr double kNearlyEvery = 0.8;

bool is_fraction(const Comb& comb, double period_s) {
  return comb.period_s < kMuchFaster * period_s &&
         static_cast<double>(comb.edges) < kNearlyEvery * (comb.turns + 1.0);
}

}  // namespace

void RateStepWatch::add(TaiTime t, bool good) {
  recent_.push_back({.t = t, .good = good});
  if (recent_.size() > kRecent) {
    recent_.pop_front();
  }
}

std::optional<Comb> RateStepWatch::new_comb(double noise_s, double period_s) const {
  const auto wrong = std::count_if(recent_.begin(), recent_.end(),
                                   [](const ReferenceEdge& edge) { return !edge.good; });
  if (wrong < kDoubtful || recent_.back().good) {
    return std::nullopt;
  }
  std::vector<TaiTime> edges(recent_.size());
  std::transform(recent_.begin(), recent_.end(), edges.begin(),
                 [](const ReferenceEdge& edge) { return edge.t; });
  auto comb = find_comb(edges, noise_s, kFewestAfterStep);
  if (!comb || is_fraction(*comb, period_s)) {
    return std::nullopt;
  }
  const SpinClock teeth{setting_of(*comb, noise_s)};
  const double limit = std::max(0.005, 6.0 * comb->scatter_s / comb->period_s);
  const auto on_comb = [&](TaiTime t) {
    return std::abs(std::remainder(teeth.phase_turns(t), 1.0)) <= limit;
  };
  // Most of the edges that the clock thinks good lie on the comb: it is the clock's own.
  std::size_t agreeing = 0;
  for (const ReferenceEdge& edge : recent_) {
    agreeing += edge.good && on_comb(edge.t) ? 1U : 0U;
  }
  return 4 * agreeing < 3 * comb->edges && on_comb(recent_.back().t) ? comb : std::nullopt;
}

}  // namespace spindrift
