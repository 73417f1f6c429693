#include "pipelines/reconstruction/star_consensus.h"

#include <Eigen/Dense>
#include <algorithm>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/statistics/distributions.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kNeighbours = 4;

Turn joined(const Turn& first, const Turn& then) {
  const Matrix3d back = then.turn.toRotationMatrix().transpose();
  return {
      .turn = first.turn * then.turn,
      .per_bias_s = back * first.per_bias_s + then.per_bias_s,
      .covariance_rad2 = back * first.covariance_rad2 * back.transpose() + then.covariance_rad2};
}

bool agree(const StarObservation& earlier, const StarObservation& later, const Turn& turn,
           const ConsensusNoise& noise) {
  static const double kLimit = chi_square_beyond(kContradictionChance, 3.0);
  const Vector3d off_rad = rotation_vector_of(
      turn.turn.conjugate() * (earlier.q_icrf_body.conjugate() * later.q_icrf_body));
  const Matrix3d covariance_rad2 =
      turn.covariance_rad2 + 2.0 * noise.star_rad * noise.star_rad * Matrix3d::Identity() +
      turn.per_bias_s * noise.bias_covariance_rad2_s2 * turn.per_bias_s.transpose();
  return off_rad.dot(covariance_rad2.llt().solve(off_rad)) < kLimit;
}

/// Those that agree with at least half of their neighbours among these.
std::vector<StarObservation> agreeing(const RateTrack& rates,
                                      std::span<const StarObservation> stars,
                                      const ConsensusNoise& noise) {
  std::vector<double> times_s;
  for (const StarObservation& star : stars) {
    times_s.push_back(star.t_s);
  }
  const std::vector<Turn> turns = rates.turns(times_s, noise.bias_rad_s);
  std::vector<int> compared(stars.size());
  std::vector<int> agreed(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) {
    Turn turn;
    for (std::size_t j = i + 1; j < std::min(stars.size(), i + 1 + kNeighbours); ++j) {
      turn = joined(turn, turns[j - 1]);
      const int one = agree(stars[i], stars[j], turn, noise) ? 1 : 0;
      for (const std::size_t star : {i, j}) {
        ++compared[star];
        agreed[star] += one;
      }
    }
  }
  std::vector<StarObservation> accepted;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (2 * agreed[i] >= compared[i]) {
      accepted.push_back(stars[i]);
    }
  }
  return accepted;
}

}  // namespace

StarConsensus consensus_of(const RateTrack& rates, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise) {
  StarConsensus result{.accepted = {stars.begin(), stars.end()}};
  for (std::size_t before = 0; before != result.accepted.size();) {
    before = result.accepted.size();
    result.accepted = agreeing(rates, result.accepted, noise);
  }
  result.contradict = result.accepted.empty();
  if (result.contradict) {
    result.accepted.assign(stars.begin(), stars.end());
  }
  result.gated = static_cast<std::int64_t>(stars.size() - result.accepted.size());
  return result;
}

}  // namespace spindrift
