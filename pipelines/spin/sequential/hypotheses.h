/// @file
/// Candidate axes, each with a filter that sees the same edges. They compete by likelihood: a
/// candidate is eliminated when the edges are e^20 times likelier under another one that fits them,
/// or when both filters have converged to one axis. For candidates that join after the first
/// elimination e^5 is enough, once they are as well known as the others.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

struct Hypothesis {
  SpinFilter filter;
  bool preferred_by_prior = false;  ///< Prior favours this candidate.
  double edges = 0.0;
  double log_likelihood = 0.0;       ///< Log likelihood of all its edges.
  double squared_innovations = 0.0;  ///< Sum of NIS values; expected to equal `edges`.
  RevolutionObservations said = {};  ///< Observations of the last revolution.
  int fixes = 0;                     ///< Number of fixes that name this candidate.
  bool eliminated_another = false;   ///< True once the edges have eliminated a rival.
  bool late = false;                 ///< True if it joined after the first elimination.
};

/// Number of edges needed to judge whether a hypothesis fits them.
inline constexpr double kFewestEdgesToFit = 60.0;

class Hypotheses {
 public:
  /// @param provisional True when the true axis may be missing; then the edges settle nothing.
  explicit Hypotheses(bool provisional = false) : provisional_{provisional} {}

  bool empty() const { return all_.empty(); }
  std::size_t count() const { return all_.size(); }
  bool provisional() const { return provisional_; }
  /// Returns whether one candidate is left, chosen by a fix or by the edges.
  bool settled() const { return (settled_ || closed()) && all_.size() == 1; }
  /// Returns whether the edges chose the last candidate, among candidates that several fixes named.
  bool settled_by_edges() const { return closed() && all_.size() == 1; }

  /// Returns whether the published candidate has eliminated all that joined before its first
  /// elimination, so that no more may join; false candidates of later fixes would do so endlessly.
  bool closed() const;

  /// Returns the candidates, likeliest first, but with the prior's candidate in front until the
  /// edges beat it. The first is the published one and must exist.
  const std::vector<Hypothesis>& all() const { return all_; }
  const Hypothesis& published() const { return all_.front(); }

  /// Returns where the candidates are, in the same order.
  std::vector<StartingPoint> followed() const;

  /// Describes the best other axis and how much lower its log likelihood is.
  struct Rival {
    Eigen::Vector3d axis_icrf;
    double less;
  };
  /// Returns the best remaining rival, else the last one eliminated; empty if there never was one.
  std::optional<Rival> rival() const;

  /// Returns whether `point` contradicts the axes of all filters.
  bool contradicted_by(const StartingPoint& point) const;

  /// Returns whether only a prior chose the published candidate and the edges do not oppose it.
  bool prior_stands() const;

  /// Adds a candidate with the log likelihood of the published one. If that one was settled or the
  /// list closed, it loses its earlier elimination and both start equal.
  /// @return False when none of the revolution's edges determines the phase.
  bool try_start(const StartingPoint& point, const SpinConfig& config, const Revolution& revolution,
                 const Sky& sky);

  /// Counts the fixes that name each candidate.
  void count_fix(const StartingPoints::Known& said);

  /// Keeps only the candidate that a fix names, unless the fix contradicts all candidates.
  void settle_at(const StartingPoint& point);
  /// Publishes the candidate that a prior names, but keeps the others until the edges decide.
  void prefer_at(const StartingPoint& point);
  /// Likewise the candidate that is now within three sigmas of a prior, if it is the only one.
  void prefer_near(const SpinPrior& prior);

  /// @param noise Excess noise that widens the filters' gates.
  /// @return True when the edges have beaten the candidate that a prior had chosen.
  bool work_in(const SpinConfig& config, const Revolution& revolution, const Sky& sky,
               const ChannelNoise& noise);

 private:
  std::vector<Hypothesis>::iterator at(const StartingPoint& point);
  bool drop_eliminated();

  std::vector<Hypothesis> all_;
  bool provisional_;
  bool settled_ = false;
  std::optional<Rival> eliminated_;
};

}  // namespace spindrift
