#include "pipelines/reconstruction/chain.h"

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/chain_covariance.h"
#include "pipelines/reconstruction/chain_fit.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"

namespace spindrift::chain_test {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr ChainNoise kNoise{
    .sun_rad = 0.01, .star_rad = 1e-4, .bias_rad_s = 1e-3, .misalignment_rad = 0.02};

/// Returns noise-free observations of a body that rotates by a radian in ten seconds: sun vectors
/// and two star fixes.
Chain chain_with(const ChainNoise& noise, const Vector3d& bias_rad_s = Vector3d::Zero(),
                 const std::vector<double>& sun_times_s = {2.0, 3.0, 5.5, 8.0}) {
  std::vector<TimedRate> samples;
  for (int i = 0; i <= 40; ++i) {
    const double t_s = 0.25 * i;
    samples.push_back({t_s, Vector3d{0.1 + 0.05 * std::sin(t_s), 0.05, -0.02 * t_s} + bias_rad_s});
  }
  const RateTrack rates{samples, 0.0, 10.0, 3e-5};
  const Quaterniond start = Quaterniond{0.5, -0.3, 0.6, 0.4}.normalized();
  const Vector3d sun_icrf = Vector3d{0.2, -0.7, 0.4}.normalized();
  const auto at = [&](double t_s) {
    return t_s > 0.0 ? start * rates.turns(std::vector{0.0, t_s}, bias_rad_s).front().turn : start;
  };
  std::vector<SunObservation> sun;
  for (const double t_s : sun_times_s) {
    sun.push_back({t_s, at(t_s).conjugate() * sun_icrf, sun_icrf});
  }
  const std::vector<StarObservation> stars{{7.0, at(7.0)}, {10.0, at(10.0)}};
  return chain_of(rates, {0.0, 10.0}, sun, stars, Vector3d::Zero(), noise);
}

/// Returns the whitened residuals of the problem after a change of all unknowns: three for each
/// node, then bias and misalignment.
VectorXd residuals_at(const Chain& chain, const ChainState& state, const VectorXd& moved) {
  const auto nodes = static_cast<Eigen::Index>(state.q_icrf_body.size());
  const auto q = [&](std::size_t node) {
    return state.q_icrf_body[node] *
           quaternion_by(moved.segment<3>(3 * static_cast<Eigen::Index>(node)));
  };
  const Vector3d bias = state.bias_rad_s + moved.segment<3>(3 * nodes);
  const Vector3d misalignment = state.misalignment_rad + moved.segment<3>(3 * nodes + 3);
  std::vector<double> all;
  const auto add = [&](const Vector3d& residual) {
    all.insert(all.end(), residual.begin(), residual.end());
  };
  for (std::size_t i = 0; i < chain.turns.size(); ++i) {
    const Turn& turn = chain.turns[i];
    const Quaterniond turned =
        turn.turn * quaternion_by(turn.per_bias_s * (bias - chain.bias_rad_s));
    const Matrix3d whitening = turn.covariance_rad2.inverse().llt().matrixU();
    add(whitening * rotation_vector_of(turned.conjugate() * q(i).conjugate() * q(i + 1)));
  }
  for (const ChainSun& sun : chain.sun) {
    const Vector3d predicted =
        quaternion_by(misalignment) * (q(sun.node).conjugate() * sun.of.sun_icrf);
    add((predicted - sun.of.measured_body) / chain.noise.sun_rad);
  }
  for (const ChainStar& star : chain.stars) {
    add(rotation_vector_of(star.of.q_icrf_body.conjugate() * q(star.node)) / chain.noise.star_rad);
  }
  add(bias / chain.noise.bias_rad_s);
  add(misalignment / chain.noise.misalignment_rad.value());
  return Eigen::Map<VectorXd>{all.data(), static_cast<Eigen::Index>(all.size())};
}

TEST(Chain, CovarianceIsThatOfTheWholeProblemAtOnce) {
  const Chain chain = chain_with(kNoise);
  const ChainState state = started_at(chain, chain.stars.front());
  const auto nodes = static_cast<Eigen::Index>(state.q_icrf_body.size());
  const Eigen::Index unknowns = 3 * nodes + 6;
  constexpr double kStep = 1e-6;
  MatrixXd slopes(residuals_at(chain, state, VectorXd::Zero(unknowns)).size(), unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const VectorXd step = kStep * VectorXd::Unit(unknowns, i);
    slopes.col(i) =
        (residuals_at(chain, state, step) - residuals_at(chain, state, -step)) / (2.0 * kStep);
  }
  const MatrixXd expected = (slopes.transpose() * slopes).inverse();
  const ChainCovariance found = covariance_of(chain, state);
  for (Eigen::Index i = 0; i < nodes; ++i) {
    const MatrixXd node = expected.block(3 * i, 3 * i, 3, 3);
    const MatrixXd mixed = expected.block(3 * i, 3 * nodes, 3, 6);
    const auto at = static_cast<std::size_t>(i);
    EXPECT_LT((found.nodes_rad2[at] - node).norm(), 1e-4 * node.norm()) << i;
    EXPECT_LT((found.node_shared[at] - mixed).norm(), 1e-4 * mixed.norm()) << i;
  }
  const MatrixXd shared = expected.bottomRightCorner(6, 6);
  EXPECT_LT((found.shared - shared).norm(), 1e-4 * shared.norm());
}

TEST(Chain, CovarianceOfAGyroWithoutNoiseIsThatOfTheStarFixes) {
  Chain chain = chain_with(
      {.sun_rad = 1.0, .star_rad = 1e-4, .bias_rad_s = 1e-12, .misalignment_rad = std::nullopt});
  for (Turn& turn : chain.turns) {
    turn.covariance_rad2 *= 1e-24;
  }
  const ChainCovariance found = covariance_of(chain, started_at(chain, chain.stars.front()));
  for (const Matrix3d& node : found.nodes_rad2) {
    EXPECT_NEAR(node.trace(), 3.0 * 0.5e-8, 1e-12);
  }
}

TEST(Chain, FitFindsAttitudesAndBiasFromFarOff) {
  const Vector3d bias_rad_s{2e-3, -1e-3, 1.5e-3};
  ChainNoise noise = kNoise;
  noise.misalignment_rad.reset();
  const Chain chain = chain_with(noise, bias_rad_s);
  ChainState start = started_at(chain, chain.stars.front());
  for (Quaterniond& q : start.q_icrf_body) {
    q = q * quaternion_by({0.3, -0.2, 0.25});
  }
  const auto found = value_or_throw(fit(chain, start, SunLoss::Far));
  // The prior pulls the bias slightly towards zero.
  EXPECT_LT((found.state.bias_rad_s - bias_rad_s).norm(), 0.02 * bias_rad_s.norm());
  const ChainStar& star = chain.stars.front();
  EXPECT_LT(angle_between_rad(found.state.q_icrf_body[star.node], star.of.q_icrf_body),
            0.2 * noise.star_rad);
}

/// Intervals may be as short as the rounding of times, too short to determine gyro noise.
TEST(Chain, FitConvergesWhateverTheTimeBetweenSamples) {
  const Vector3d bias_rad_s{2e-3, -1e-3, 1.5e-3};
  const auto bias_of = [&](const std::vector<double>& sun_times_s) -> Vector3d {
    const Chain chain = chain_with(kNoise, bias_rad_s, sun_times_s);
    const ChainFit found = fit(chain, started_at(chain, chain.stars.front()), SunLoss::Far).value();
    EXPECT_LT(found.iterations, 15);
    return found.state.bias_rad_s;
  };
  EXPECT_LT((bias_of({2.0, 2.0 + 1e-14, 3.0, 7.0 + 1e-14}) - bias_of({2.0, 2.0, 3.0, 7.0})).norm(),
            1e-7);
}

TEST(Chain, SunVectorsWeighLikeLeastSquaresAndFarOnesNothing) {
  EXPECT_EQ(weight_of(16.0), 1.0);
  EXPECT_GT(weight_of(17.0), 0.9);
  EXPECT_EQ(weight_of(64.0), 0.0);
  EXPECT_EQ(weight_of(1e6), 0.0);
}

}  // namespace spindrift::chain_test
