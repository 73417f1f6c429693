#include "pipelines/spin/association/period_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipelines/spin/association/copies.h"
#include "pipelines/spin/association/robust_line.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/statistics/median.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kShortest_s = 60.0 / kFastestSearched_rpm;
constexpr double kLongest_s = 60.0 / kSlowestSearched_rpm;
// Part of the period within which an edge is on the comb while that is being found.
constexpr double kNear = 0.02;
// Part of it once the comb is fitted, unless the stated noise asks for more.
constexpr double kOn = 0.005;
// The longest period is taken that explains this part of what any explains.
constexpr double kNearlyAsMany = 0.8;
constexpr double kLeastShare = 0.65;
// Least share of turns with an edge: with fewer, the period is a fraction of the true one.
constexpr double kLeastFilled = 0.45;
constexpr double kMostDrift_per_s2 = drift_per_s2(kMostDrift_rpm_h);
// Where up to six receivers give each edge, this share of the intervals is at most about a turn; a
// turn is at least kLeastOfInterval of the interval at that quantile.
constexpr double kAboutATurn = 0.875;
constexpr double kLeastOfInterval = 0.5;

using Teeth = std::vector<PhasePoint>;  // The phase here is a time in seconds.

/// Adds to `teeth` the edges that follow its last one by whole periods.
template <class Iterator>
void walk(Iterator edge, Iterator end, double period_s, Teeth& teeth) {
  const PhasePoint origin = teeth.front();
  PhasePoint last = teeth.back();
  for (; edge != end; ++edge) {
    const double turns = std::round((*edge - last.phase) / period_s);
    if (turns == 0.0) {
      continue;
    }
    const double known_turns = std::abs(last.turn - origin.turn);
    const double reach = 1.0 + std::min(std::abs(turns) / std::max(1.0, known_turns), 4.0);
    if (std::abs(*edge - last.phase - turns * period_s) <= kNear * period_s * reach) {
      last = {.turn = last.turn + turns, .phase = *edge};
      teeth.push_back(last);
      period_s = (last.phase - origin.phase) / (last.turn - origin.turn);
    }
  }
}

Teeth teeth_from(const std::vector<double>& edges_s, std::size_t first, double period_s) {
  const auto origin = edges_s.begin() + static_cast<std::ptrdiff_t>(first);
  Teeth ahead{{.turn = 0.0, .phase = *origin}};
  walk(origin + 1, edges_s.end(), period_s, ahead);
  Teeth teeth{ahead.front()};
  walk(std::make_reverse_iterator(origin), edges_s.rend(), period_s, teeth);
  std::reverse(teeth.begin(), teeth.end());
  teeth.insert(teeth.end(), ahead.begin() + 1, ahead.end());
  return teeth;
}

/// Counts the turns from the first tooth to the last, without silences.
double turns_heard(const Teeth& teeth) {
  double turns = 1.0;
  for (std::size_t i = 1; i < teeth.size(); ++i) {
    // A longer gap is a silence, not lost edges.
    turns += std::min(teeth[i].turn - teeth[i - 1].turn, 5.0);
  }
  return turns;
}

struct Found {
  double period_s;
  Teeth teeth;
};

Found best_teeth(const std::vector<double>& edges_s) {
  Found best{.period_s = 0.0, .teeth = {}};
  std::size_t most = 0;
  for (std::size_t i = 0; i < edges_s.size(); ++i) {
    // Edges up to three places apart may be one turn apart, with spurious ones between them.
    for (std::size_t j = i + 1; j < std::min(i + 4, edges_s.size()); ++j) {
      const double period_s = edges_s[j] - edges_s[i];
      if (!(period_s >= kShortest_s && period_s <= kLongest_s)) {
        continue;
      }
      Teeth teeth = teeth_from(edges_s, i, period_s);
      most = std::max(most, teeth.size());
      const auto count = static_cast<double>(teeth.size());
      const bool explains_more = teeth.size() > best.teeth.size();
      const bool much_longer = period_s > 1.2 * best.period_s;
      const bool much_shorter = period_s < best.period_s / 1.2;
      const bool better = much_longer ? count >= kNearlyAsMany * static_cast<double>(most)
                          : much_shorter
                              ? static_cast<double>(best.teeth.size()) < kNearlyAsMany * count
                              : explains_more;
      if (better) {
        best = {.period_s = period_s, .teeth = std::move(teeth)};
      }
    }
  }
  return best;
}

void straighten(Teeth& teeth, double bend) {
  for (PhasePoint& tooth : teeth) {
    tooth.phase -= 0.5 * bend * tooth.turn * tooth.turn;
  }
}

/// Returns the relative change of the period in a turn: the median over the parabolas through three
/// teeth far apart, or 0 unless it explains the teeth far better than an even comb.
double bend_of(const Teeth& teeth, double noise, double period_s) {
  const std::size_t apart = teeth.size() / 3;
  if (apart == 0) {
    return 0.0;
  }
  const auto slope = [&](std::size_t from, std::size_t to) {
    return (teeth[to].phase - teeth[from].phase) / (teeth[to].turn - teeth[from].turn);
  };
  std::vector<double> bends;
  for (std::size_t i = 0; i + 2 * apart < teeth.size(); ++i) {
    bends.push_back(2.0 * (slope(i + apart, i + 2 * apart) - slope(i, i + apart)) /
                    (teeth[i + 2 * apart].turn - teeth[i].turn));
  }
  const double bend = upper_median(bends);
  Teeth straight = teeth;
  straighten(straight, bend);
  // An uneven comb is taken if it leaves less than this part of the scatter about an even one.
  const bool better = fit_robust_line(straight, noise, kNear * 2.0)->scatter <
                      0.5 * fit_robust_line(teeth, noise, kNear * 2.0)->scatter;
  const bool possible = std::abs(bend) <= kMostDrift_per_s2 * period_s * period_s;
  return better && possible ? bend : 0.0;
}

std::optional<PulseTrain> train_of(std::span<const TaiTime> edges, double noise_s,
                                   std::size_t fewest) {
  edges = edges.last(std::min(edges.size(), std::size_t{32}));
  if (edges.size() < fewest) {
    return std::nullopt;
  }
  std::vector<double> edges_s(edges.size());
  std::transform(edges.begin(), edges.end(), edges_s.begin(),
                 [&](TaiTime t) { return elapsed_s(edges.front(), t); });
  const Found found = best_teeth(edges_s);
  const double period_s = found.period_s;
  const Teeth& teeth = found.teeth;
  const auto share = static_cast<double>(teeth.size()) / static_cast<double>(edges.size());
  if (teeth.size() < fewest || share < kLeastShare ||
      static_cast<double>(teeth.size()) < kLeastFilled * turns_heard(teeth)) {
    return std::nullopt;
  }

  // The points are in units of the period, relative to the first tooth.
  std::vector<PhasePoint> points(teeth.size());
  std::transform(teeth.begin(), teeth.end(), points.begin(), [&](const PhasePoint& tooth) {
    const double turn = tooth.turn - teeth.front().turn;
    return PhasePoint{.turn = turn, .phase = (tooth.phase - teeth.front().phase) / period_s - turn};
  });
  const double bend = bend_of(points, noise_s / period_s, period_s);
  straighten(points, bend);
  const auto line = fit_robust_line(points, noise_s / period_s, kNear * 2.0);
  const double limit = std::max(kOn, kOnComb_sigma * noise_s / period_s);
  const auto on_it = std::count_if(points.begin(), points.end(), [&](const PhasePoint& point) {
    return std::abs(point.phase - line->at(point.turn)) <= limit;
  });
  if (static_cast<std::size_t>(on_it) < fewest ||
      static_cast<double>(on_it) < kLeastShare * static_cast<double>(edges.size()) ||
      static_cast<double>(on_it) < kLeastFilled * turns_heard(teeth)) {
    return std::nullopt;
  }
  return PulseTrain{.t = later_by_s(edges.front(), teeth.front().phase + line->at(0.0) * period_s),
                    .period_s = period_s * (1.0 + line->drift),
                    .drift_per_s2 = -bend / (period_s * period_s),
                    .scatter_s = line->scatter * period_s,
                    .edges = static_cast<std::size_t>(on_it),
                    .turns = points.back().turn};
}

/// Returns an interval of nearly a turn where edges come several times, else of nearly two or less.
double interval_about_a_turn_s(std::span<const TaiTime> edges) {
  std::vector<double> intervals_s(edges.size() - 1);
  std::transform(edges.begin(), edges.end() - 1, edges.begin() + 1, intervals_s.begin(), elapsed_s);
  const double place = kAboutATurn * static_cast<double>(intervals_s.size());
  return in_order_at(intervals_s, static_cast<std::size_t>(place));
}

/// Returns the first edge of each group within `within_s`; empty where most edges come alone.
std::vector<TaiTime> first_of_copies(std::span<const TaiTime> edges, double within_s) {
  std::vector<TaiTime> first;
  std::vector<bool> copied;
  for (const TaiTime t : edges) {
    if (!first.empty() && elapsed_s(first.back(), t) <= within_s) {
      copied.back() = true;
    } else {
      first.push_back(t);
      copied.push_back(false);
    }
  }
  const auto with = std::count(copied.begin(), copied.end(), true);
  return 2 * with > std::ssize(copied) ? first : std::vector<TaiTime>{};
}

// The clock is doubted when kDoubtful of the last kRecent edges are not where it expects them.
constexpr std::size_t kRecent = 9;
constexpr std::ptrdiff_t kDoubtful = 4;
constexpr std::size_t kFewestAfterStep = 6;
// A comb with a shorter period than this part of the clock's is a faster body if nearly every turn
// has an edge. Otherwise the time stamps have stepped by a fraction of a turn.
constexpr double kMuchFaster = 0.75;
constexpr double kNearlyEvery = 0.8;

bool is_fraction(const PulseTrain& comb, double period_s) {
  return comb.period_s < kMuchFaster * period_s &&
         static_cast<double>(comb.edges) < kNearlyEvery * (comb.turns + 1.0);
}

/// Tells whether the comb is the clock's own with edges on every second turn or fewer.
bool is_multiple(const PulseTrain& comb, double period_s) {
  const double clock_turns = comb.period_s / period_s;
  const double whole = std::round(clock_turns);
  // Turns by which the whole comb may deviate from a whole multiple of the clock period.
  return whole > 1.0 && std::abs(clock_turns - whole) * comb.turns < 0.05;
}

}  // namespace

std::optional<PulseTrain> find_pulse_train(std::span<const TaiTime> edges, double noise_s,
                                           std::size_t fewest) {
  if (auto train = train_of(edges, noise_s, fewest)) {
    return train;
  }
  if (edges.size() < 2) {
    return std::nullopt;
  }
  const double interval_s = interval_about_a_turn_s(edges);
  auto train = train_of(first_of_copies(edges, kCopies_turns * interval_s), noise_s, fewest);
  return train && train->period_s >= kLeastOfInterval * interval_s ? train : std::nullopt;
}

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
