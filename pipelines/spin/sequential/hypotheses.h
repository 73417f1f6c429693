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
  bool preferred_by_prior = false;  ///< By a prior.
  double edges = 0.0;
  double log_likelihood = 0.0;       ///< Of them.
  double squared_innovations = 0.0;  ///< Normalised, their sum: as many as edges when all is well.
  RevolutionObservations said = {};  ///< By the edges of the last revolution.
  int fixes = 0;                     ///< That have it among their candidates.
  bool eliminated_another = false;   ///< Eliminated another, by the edges.
  bool late = false;                 ///< Came when the one then published had beaten another.
};

/// So many edges say whether a hypothesis fits them.
inline constexpr double kFewestEdgesToFit = 60.0;

class Hypotheses {
 public:
  /// @param provisional The true axis may be missing: then the edges settle nothing.
  explicit Hypotheses(bool provisional = false) : provisional_{provisional} {}

  bool empty() const { return all_.empty(); }
  std::size_t count() const { return all_.size(); }
  bool provisional() const { return provisional_; }
  /// One is left, chosen by a fix or by the edges.
  bool settled() const { return (settled_ || closed()) && all_.size() == 1; }
  /// Chosen by the edges among candidates that several fixes have named.
  bool settled_by_edges() const { return closed() && all_.size() == 1; }

  /// The one published has eliminated all that joined before its first elimination: those left are
  /// the last to be judged. Otherwise false candidates of later fixes would keep joining.
  bool closed() const;

  /// The likeliest first, but before it the prior's, until the edges beat that; likewise
  /// `published`, of which there must be one.
  const std::vector<Hypothesis>& all() const { return all_; }
  const Hypothesis& published() const { return all_.front(); }

  /// The best other axis, and by how much the edges' log likelihood is less about it.
  struct Rival {
    Eigen::Vector3d axis_icrf;
    double less;
  };
  /// That which competes; where none does, the last one that was eliminated; empty: none was.
  std::optional<Rival> rival() const;

  /// No filter may have this axis.
  bool contradicted_by(const StartingPoint& point) const;

  /// Nothing but a prior chose the one published, and the edges do not speak against it.
  bool prior_stands() const;

  /// Adds a candidate that is taken to be as likely so far as the one published; where that was
  /// settled, or the list closed, both begin equal.
  /// @return False where none of the revolution's edges can tell its phase.
  bool add(const StartingPoint& point, const SpinConfig& config, const Revolution& revolution,
           const Sky& sky);

  /// Fixes have said this.
  void note(const StartingPoints::Known& said);

  /// A fix settles which of them is true, unless it contradicts them all.
  void settle_at(const StartingPoint& point);
  /// Likewise a prior, but the others stay until the edges settle it.
  void prefer_at(const StartingPoint& point);

  /// @param noise Of the filters' update.
  /// @return Whether the edges have beaten the candidate that a prior had chosen.
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
