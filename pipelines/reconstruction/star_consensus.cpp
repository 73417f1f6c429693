#include "pipelines/reconstruction/star_consensus.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kNeighbours = 4;

bool is_left_out(const Observation& said) { return said.rejected_by.has_value(); }

Turn joined(const Turn& first, const Turn& then) {
  const Matrix3d back = then.turn.toRotationMatrix().transpose();
  return {
      .turn = first.turn * then.turn,
      .per_bias_s = back * first.per_bias_s + then.per_bias_s,
      .per_gyro_error = back * first.per_gyro_error + then.per_gyro_error,
      .covariance_rad2 = back * first.covariance_rad2 * back.transpose() + then.covariance_rad2};
}

/// Holds the difference of one fix from its prediction by another, in body axes at that fix.
struct Difference {
  Residual residual;
  double nis;
};

/// Returns the differences of the later fix and of the earlier fix.
std::array<Difference, 2> differences(const RateTrack& rates, const StarObservation& earlier,
                                      const StarObservation& later, const Turn& turn,
                                      const ConsensusNoise& noise) {
  const Vector3d off_rad = rotation_vector_of(
      turn.turn.conjugate() * (earlier.q_icrf_body.conjugate() * later.q_icrf_body));
  const PerShared slopes = difference_per_shared(rates, earlier, later, turn);
  const Matrix3d covariance_rad2 = turn.covariance_rad2 +
                                   2.0 * noise.star_rad * noise.star_rad * Matrix3d::Identity() +
                                   slopes * noise.shared * slopes.transpose();
  const double nis = off_rad.dot(covariance_rad2.llt().solve(off_rad));
  const auto about = [&](const Matrix3d& axes) {
    return Residual{.freedom = 3,
                    .value = axes * off_rad,
                    .sigma = (axes * covariance_rad2 * axes.transpose()).diagonal().cwiseSqrt()};
  };
  return {Difference{about(Matrix3d::Identity()), nis},
          Difference{about(-turn.turn.toRotationMatrix()), nis}};
}

/// Returns the observation relative to the neighbour with the median difference, the lower of two
/// medians. If it passes the gate, at least half of the neighbours agree.
Observation said_by(TaiTime t, std::vector<Difference> differ) {
  Observation said{.t = t, .source = SampleSource::Star, .limit = innovation_gate(3)};
  if (differ.empty()) {
    return said;
  }
  const auto middle = differ.begin() + (std::ssize(differ) - 1) / 2;
  std::ranges::nth_element(differ, middle, {}, &Difference::nis);
  said.residual = middle->residual;
  said.nis = middle->nis;
  if (said.nis > said.limit) {
    said.rejected_by = Rejection::Innovation;
  }
  return said;
}

std::vector<Observation> observations_among(std::span<const StarObservation> stars,
                                            const Observations& all, const ConsensusNoise& noise) {
  std::vector<double> times_s;
  for (const StarObservation& star : stars) {
    times_s.push_back(star.t_s);
  }
  const std::vector<Turn> turns = all.rates.turns(times_s, noise.bias_rad_s);
  std::vector<std::vector<Difference>> differ(stars.size());
  for (std::size_t i = 0; i < stars.size(); ++i) {
    Turn turn;
    for (std::size_t j = i + 1; j < std::min(stars.size(), i + 1 + kNeighbours); ++j) {
      turn = joined(turn, turns[j - 1]);
      const auto [of_later, of_earlier] = differences(all.rates, stars[i], stars[j], turn, noise);
      differ[j].push_back(of_later);
      differ[i].push_back(of_earlier);
    }
  }
  std::vector<Observation> said;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    said.push_back(said_by(shifted(all.origin, stars[i].t_s), std::move(differ[i])));
  }
  return said;
}

}  // namespace

PerShared difference_per_shared(const RateTrack& rates, const StarObservation& earlier,
                                const StarObservation& later, const Turn& turn) {
  const Matrix3d back = turn.turn.toRotationMatrix().transpose();
  PerShared slopes = PerShared::Zero();
  slopes.middleCols<kTurnErrors>(SharedGyroBias) = turn.per_error();
  slopes.middleCols<3>(SharedStarTracker) = back - Matrix3d::Identity();
  slopes.col(SharedStarTime) = back * rates.rate_at(earlier.t_s) - rates.rate_at(later.t_s);
  return slopes;
}

StarConsensus consensus_of(const Observations& all, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise) {
  StarConsensus result{.accepted = {stars.begin(), stars.end()}};
  std::vector<Observation> said = observations_among(stars, all, noise);
  std::vector<Observation> of_all = said;
  while (std::any_of(said.begin(), said.end(), is_left_out)) {
    std::vector<StarObservation> agree;
    for (std::size_t i = 0; i < said.size(); ++i) {
      if (is_left_out(said[i])) {
        result.said.push_back(said[i]);
      } else {
        agree.push_back(result.accepted[i]);
      }
    }
    result.accepted = std::move(agree);
    said = observations_among(result.accepted, all, noise);
  }
  result.contradict = result.accepted.empty();
  if (result.contradict) {
    result.accepted.assign(stars.begin(), stars.end());
    result.said.clear();
    said = std::move(of_all);
    for (Observation& one : said) {
      one.rejected_by.reset();
    }
  }
  result.add(said);
  return result;
}

void StarConsensus::add(const std::vector<Observation>& more) {
  said.insert(said.end(), more.begin(), more.end());
  std::sort(said.begin(), said.end(),
            [](const Observation& a, const Observation& b) { return a.t < b.t; });
}

std::vector<Observation> StarConsensus::gated() const {
  std::vector<Observation> gated;
  std::copy_if(said.begin(), said.end(), std::back_inserter(gated), is_left_out);
  return gated;
}

}  // namespace spindrift
