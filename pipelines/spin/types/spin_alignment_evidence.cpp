#include "pipelines/spin/types/spin_alignment_evidence.h"

#include <Eigen/LU>

namespace spindrift {

SpinAlignmentEvidence beside_offsets(const ConsideredPrior& information,
                                     const ConsideredVector& score, const ConsideredPrior& prior) {
  SpinAlignmentEvidence evidence{.information = of_alignment(information),
                                 .score = score.tail<kSpinAlignmentErrors>()};
  Considered<kSpinAlignmentErrors, kChannelOffsets> offsets;
  offsets.shared = information.bottomLeftCorner<kSpinAlignmentErrors, kChannelOffsets>();
  offsets.own = information.topLeftCorner<kChannelOffsets, kChannelOffsets>();
  offsets.score = score.head<kChannelOffsets>();
  offsets.eliminate(prior.topLeftCorner<kChannelOffsets, kChannelOffsets>(), evidence.information,
                    evidence.score);
  return evidence;
}

std::optional<AlignmentExcess> worst_excess(const SpinAlignmentEvidence& evidence,
                                            const SpinAlignment& prior) {
  const auto& [information, score] = evidence;
  const SpinAlignment known =
      (SpinAlignment::Identity() + prior * information).partialPivLu().solve(prior);
  const SpinAlignment left = information - information * known * information;
  const SpinAlignmentVector left_score = score - information * known * score;
  std::optional<AlignmentExcess> worst;
  for (int i = 0; i < kSpinAlignmentErrors; ++i) {
    // An error that the unknowns take up explains nothing, whatever rounding leaves of it.
    if (!(left(i, i) > 1e-9 * information(i, i))) {
      continue;
    }
    const double value = left_score[i] / left(i, i);
    const double gain = left_score[i] * value;
    if (!worst || gain > worst->gain) {
      worst = {.error = static_cast<SpinAlignmentError>(i), .value = value, .gain = gain};
    }
  }
  return worst;
}

}  // namespace spindrift
