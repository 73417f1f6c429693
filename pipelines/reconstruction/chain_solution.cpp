#include "pipelines/reconstruction/chain_solution.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_covariance.h"
#include "pipelines/reconstruction/chain_fit.h"
#include "pipelines/statistics/considered.h"
#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns every n-th sample within the span, such that at most `most` remain.
template <class Sample>
std::vector<Sample> thinned(std::span<const Sample> samples, double first_s, double last_s,
                            std::size_t most) {
  std::vector<Sample> within;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(within),
               [=](const Sample& s) { return s.t_s >= first_s && s.t_s <= last_s; });
  const std::size_t stride = within.size() / most + 1;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < within.size(); i += stride) {
    some.push_back(within[i]);
  }
  return some;
}

/// Solves over growing spans about the first star fix. The bias found in one span keeps the
/// propagation error small in the next.
Expected<SolvedChain> coarse_solution(const Observations& all,
                                      std::span<const StarObservation> stars,
                                      const ChainNoise& noise) {
  const StarObservation& first = stars.front();
  Vector3d bias_rad_s = Vector3d::Zero();
  int iterations = 0;
  // The first span is so short that no gyro bias turns the body far within it.
  for (double span_s = 300.0;; span_s *= 4.0) {
    const double from_s = std::max(0.0, first.t_s - span_s);
    const double to_s = std::min(all.end_s, first.t_s + span_s);
    const std::span<const SunObservation> sun{all.sun};
    SolvedChain solved{.chain = chain_of(all.rates, {from_s, to_s}, thinned(sun, from_s, to_s, 300),
                                         thinned(stars, from_s, to_s, 100), bias_rad_s, noise),
                       .state = {},
                       .iterations = 0};
    auto fitted =
        fit(solved.chain, started_at(solved.chain, solved.chain.stars.front()), SunLoss::Far);
    if (!fitted) {
      return Unexpected{fitted.error()};
    }
    iterations += fitted->iterations;
    bias_rad_s = fitted->state.bias_rad_s;
    if (from_s == 0.0 && to_s == all.end_s) {
      solved.state = std::move(fitted->state);
      solved.iterations = iterations;
      return solved;
    }
  }
}

double louder_sun(const SolvedChain& solved, const ChainInformation& known,
                  const FittedFile& file) {
  std::vector<double> lengths;
  for (const ChainSun& sun : solved.chain.sun) {
    lengths.push_back(
        left_of(residual_of(sun, solved.state), known.per_shared[sun.node], file.change).norm());
  }
  // The median length of a vector of two standard normal components is 1.17741.
  const double louder = upper_median(lengths) / 1.17741 / solved.chain.noise.sun_rad;
  return louder > kLouder ? louder : 1.0;
}

/// Returns the star noise as a multiple of the stated one, from the differences of adjacent fixes
/// to the gyro turn, if significant; at least 1. Residuals of the solution would show less, because
/// the chain follows each fix.
double louder_star(const RateTrack& rates, std::span<const StarObservation> stars,
                   const ChainNoise& noise, const Vector3d& bias_rad_s) {
  std::vector<double> times_s;
  for (const StarObservation& star : stars) {
    times_s.push_back(star.t_s);
  }
  const std::vector<Turn> turns = rates.turns(times_s, bias_rad_s);
  std::vector<Vector3d> off_rad;
  std::vector<PerShared> slopes;
  Considered<0, kSharedErrors> file;
  double squares = 0.0;
  double expected_rad2 = 0.0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vector3d& off = off_rad.emplace_back(rotation_vector_of(
        turns[i].turn.conjugate() * (stars[i].q_icrf_body.conjugate() * stars[i + 1].q_icrf_body)));
    const PerShared& slope =
        slopes.emplace_back(difference_per_shared(rates, stars[i], stars[i + 1], turns[i]));
    const Matrix3d covariance_rad2 =
        turns[i].covariance_rad2 + 2.0 * noise.star_rad * noise.star_rad * Matrix3d::Identity();
    const Eigen::LLT<Matrix3d> root{covariance_rad2};
    file.own += slope.transpose() * root.solve(slope);
    file.score += slope.transpose() * root.solve(off);
    squares += off.dot(root.solve(off));
    expected_rad2 += covariance_rad2.trace();
  }
  // The bias is that of a solution; the errors of the mission file are those that fit best.
  const SharedVector fitted = file.estimate(prior_of(0.0, noise.alignment));
  squares -= file.score.dot(fitted);
  double excess_rad2 = -expected_rad2;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    excess_rad2 += (off_rad[i] - slopes[i] * fitted).squaredNorm();
  }
  const double freedom = 3.0 * static_cast<double>(turns.size());
  if (freedom <= 3.0 || noise_is_as_stated(squares, freedom)) {
    return 1.0;
  }
  return std::sqrt(1.0 +
                   std::max(0.0, excess_rad2) / (2.0 * freedom * std::pow(noise.star_rad, 2)));
}

/// Takes attitudes from the coarse solution and propagates them to the other nodes with the gyro.
ChainState started_from(const SolvedChain& coarse, const Chain& chain) {
  ChainState state{.q_icrf_body = {},
                   .bias_rad_s = coarse.state.bias_rad_s,
                   .misalignment_rad = coarse.state.misalignment_rad};
  std::size_t known = 0;
  for (std::size_t i = 0; i < chain.times_s.size(); ++i) {
    if (known < coarse.chain.times_s.size() && coarse.chain.times_s[known] == chain.times_s[i]) {
      state.q_icrf_body.push_back(coarse.state.q_icrf_body[known++]);
    } else {
      state.q_icrf_body.push_back(
          (state.q_icrf_body.back() * chain.turns[i - 1].turn).normalized());
    }
  }
  return state;
}

std::vector<double> node_times(const ReconstructionRequest& request, const Observations& all) {
  std::vector<double> times_s{all.end_s};
  for (const EventTime& event : all.events) {
    if (event.event != SeparationEvent::Separation) {
      times_s.push_back(all.seconds_of(event.t));
    }
  }
  for (const TimedRate& sample : all.rates.samples()) {
    if (request.node_at_every_gyro_sample && sample.t_s <= all.end_s) {
      times_s.push_back(sample.t_s);
    }
  }
  return times_s;
}

ChainNoise noise_of(const ReconstructionRequest& request) {
  const auto& sun_sensor = request.sensors.sun_sensor;
  return {.sun_rad = sun_sensor ? sun_sensor->noise_rad : 1.0,
          .star_rad = request.sensors.star_tracker->noise_rad,
          .bias_rad_s = request.sensors.gyro->bias_sigma_rad_s,
          .alignment = request.sensors.alignment};
}

struct CoarseSolution {
  SolvedChain solved;
  StarConsensus stars;  ///< Consensus with the bias of the coarse solution.
  CoarseFindings found;
};

Expected<CoarseSolution> coarse_of(const ReconstructionRequest& request, const Observations& all) {
  const ChainNoise noise = noise_of(request);
  const StarConsensus first = consensus_of(
      all, all.stars,
      {.star_rad = noise.star_rad, .bias_rad_s = Vector3d::Zero(), .shared = noise.prior()});
  auto solved = coarse_solution(all, first.accepted, noise);
  if (!solved) {
    return Unexpected{solved.error()};
  }
  const ChainInformation known = information_of(solved->chain, solved->state);
  StarConsensus stars = consensus_of(all, first.accepted,
                                     {.star_rad = noise.star_rad,
                                      .bias_rad_s = solved->state.bias_rad_s,
                                      .shared = errors_of(known, noise).total});
  stars.add(first.gated());
  stars.contradict = stars.contradict || first.contradict;
  const FittedFile file = fitted_file(known, noise, solved->state);
  const CoarseFindings found{.louder_sun = louder_sun(*solved, known, file), .file = file};
  return CoarseSolution{.solved = *std::move(solved), .stars = std::move(stars), .found = found};
}

/// Widens the gates of sun vectors by what the mission file may be off by.
/// @return True if that changes what any of them weighs by more than a tenth.
bool allow_for_file(SolvedChain& solved) {
  Chain& chain = solved.chain;
  const auto is_far = [&](const ChainSun& sun) {
    return weight_of(sun, chain, solved.state) < 1.0;
  };
  if (chain.noise.alignment.isZero(0.0) || std::ranges::none_of(chain.sun, is_far)) {
    return false;
  }
  const ChainInformation known = information_of(chain, solved.state);
  const SharedErrors errors = errors_of(known, chain.noise);
  bool changes = false;
  for (ChainSun& sun : chain.sun) {
    const double before = weight_of(sun, chain, solved.state);
    const Matrix3d by_file_rad2 =
        allowed_by_file(residual_of(sun, solved.state), known.per_shared[sun.node], errors);
    sun.allowed += by_file_rad2.trace() / std::pow(chain.noise.sun_rad, 2);
    changes = changes || weight_of(sun, chain, solved.state) > before + 0.1;
  }
  return changes;
}

}  // namespace

CoarseFindings coarse_findings(const ReconstructionRequest& request, const Observations& all) {
  const auto coarse = coarse_of(request, all);
  return coarse ? coarse->found : CoarseFindings{};
}

Expected<ChainSolution> solution_of(const ReconstructionRequest& request, const Observations& all) {
  const auto coarse = coarse_of(request, all);
  if (!coarse) {
    return Unexpected{coarse.error()};
  }
  ChainNoise noise = noise_of(request);
  ChainSolution found{.solved = {},
                      .stars = coarse->stars,
                      .louder_sun = coarse->found.louder_sun,
                      .louder_star = louder_star(all.rates, coarse->stars.accepted, noise,
                                                 coarse->solved.state.bias_rad_s)};
  noise.sun_rad *= found.louder_sun;
  noise.star_rad *= found.louder_star;
  found.solved.chain = chain_of(all.rates, node_times(request, all), all.sun, found.stars.accepted,
                                coarse->solved.state.bias_rad_s, noise);
  auto fitted =
      fit(found.solved.chain, started_from(coarse->solved, found.solved.chain), SunLoss::Near);
  if (!fitted) {
    return Unexpected{fitted.error()};
  }
  found.solved.state = std::move(fitted->state);
  found.solved.iterations = coarse->solved.iterations + fitted->iterations;
  if (allow_for_file(found.solved)) {
    fitted = fit(found.solved.chain, found.solved.state, SunLoss::Near);
    if (!fitted) {
      return Unexpected{fitted.error()};
    }
    found.solved.state = std::move(fitted->state);
    found.solved.iterations += fitted->iterations;
  }
  return found;
}

}  // namespace spindrift
