#include "pipelines/reconstruction/star_consensus.h"

#include <Eigen/Dense>
#include <algorithm>
#include <iterator>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"

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

/// Normalised, of three degrees of freedom.
double squared_difference(const StarObservation& earlier, const StarObservation& later,
                          const Turn& turn, const ConsensusNoise& noise) {
  const Vector3d off_rad = rotation_vector_of(
      turn.turn.conjugate() * (earlier.q_icrf_body.conjugate() * later.q_icrf_body));
  const Matrix3d covariance_rad2 =
      turn.covariance_rad2 + 2.0 * noise.star_rad * noise.star_rad * Matrix3d::Identity() +
      turn.per_bias_s * noise.bias_covariance_rad2_s2 * turn.per_bias_s.transpose();
  return off_rad.dot(covariance_rad2.llt().solve(off_rad));
}

/// That of the neighbour in the middle, or the lower of two there: where it agrees, at least half
/// do.
double middle_of(std::vector<double> squares) {
  if (squares.empty()) {
    return 0.0;
  }
  const auto middle = squares.begin() + (std::ssize(squares) - 1) / 2;
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle;
}

/// Those that agree with at least half of their neighbours among these.
/// @param gated The others are added to it.
std::vector<StarObservation> agreeing(const RateTrack& rates,
                                      std::span<const StarObservation> stars,
                                      const ConsensusNoise& noise, std::vector<GatedStar>& gated) {
  std::vector<double> times_s;
  for (const StarObservation& star : stars) {
    times_s.push_back(star.t_s);
  }
  const std::vector<Turn> turns = rates.turns(times_s, noise.bias_rad_s);
  std::vector<std::vector<double>> squares(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) {
    Turn turn;
    for (std::size_t j = i + 1; j < std::min(stars.size(), i + 1 + kNeighbours); ++j) {
      turn = joined(turn, turns[j - 1]);
      const double apart = squared_difference(stars[i], stars[j], turn, noise);
      squares[i].push_back(apart);
      squares[j].push_back(apart);
    }
  }
  std::vector<StarObservation> accepted;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const double nis = middle_of(std::move(squares[i]));
    if (nis < innovation_gate(3)) {
      accepted.push_back(stars[i]);
    } else {
      gated.push_back({.of = stars[i], .nis = nis});
    }
  }
  return accepted;
}

}  // namespace

void add_gated(const Observations& all, const StarConsensus& stars,
               std::vector<Observation>& said) {
  for (const GatedStar& star : stars.gated) {
    said.push_back({.t = shifted(all.origin, star.of.t_s),
                    .source = SampleSource::Star,
                    .nis = star.nis,
                    .limit = innovation_gate(3),
                    .rejected_by = Rejection::Innovation});
  }
}

StarConsensus consensus_of(const RateTrack& rates, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise) {
  StarConsensus result{.accepted = {stars.begin(), stars.end()}};
  for (std::size_t before = 0; before != result.accepted.size();) {
    before = result.accepted.size();
    result.accepted = agreeing(rates, result.accepted, noise, result.gated);
  }
  result.contradict = result.accepted.empty();
  if (result.contradict) {
    result.accepted.assign(stars.begin(), stars.end());
    result.gated.clear();
  }
  return result;
}

}  // namespace spindrift
