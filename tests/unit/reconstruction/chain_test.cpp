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

const ChainNoise kExact{.sun_rad = 0.01, .star_rad = 1e-4, .bias_rad_s = 1e-3};

/// Returns correlated errors of sun sensor, star tracker, gyro and time tags.
AttitudeAlignment file_errors() {
  AttitudeAlignment sigmas = AttitudeAlignment::Zero();
  sigmas.diagonal().segment<3>(SunSensorError).setConstant(0.02);
  sigmas.diagonal().segment<3>(StarTrackerError).setConstant(2e-4);
  sigmas.diagonal().segment<3>(GyroScaleError).setConstant(1e-3);
  sigmas.diagonal().segment<6>(GyroAxisError).setConstant(2e-3);
  sigmas(StarTrackerTimeError, StarTrackerTimeError) = 0.05;
  sigmas(SunSensorTimeError, SunSensorTimeError) = 0.1;
  AttitudeAlignment mixed = AttitudeAlignment::Identity();
  mixed(SunSensorError, StarTrackerError + 1) = 0.5;
  mixed(GyroScaleError + 2, SunSensorError + 1) = -0.3;
  return sigmas * mixed * mixed.transpose() * sigmas;
}

ChainNoise with(const AttitudeAlignment& alignment) {
  ChainNoise noise = kExact;
  noise.alignment = alignment;
  return noise;
}

AttitudeAlignment of_sun_sensor(double sigma_rad) {
  AttitudeAlignment alignment = AttitudeAlignment::Zero();
  alignment.diagonal().segment<3>(SunSensorError).setConstant(sigma_rad * sigma_rad);
  return alignment;
}

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

/// Returns the whitened residuals of the samples after a change of all unknowns: three for each
/// node, then the shared errors.
VectorXd residuals_at(const Chain& chain, const ChainState& state, const VectorXd& moved) {
  const auto nodes = static_cast<Eigen::Index>(state.q_icrf_body.size());
  const auto q = [&](std::size_t node) {
    return state.q_icrf_body[node] *
           quaternion_by(moved.segment<3>(3 * static_cast<Eigen::Index>(node)));
  };
  const SharedVector shared = moved.segment<kSharedErrors>(3 * nodes);
  const Vector3d bias = state.bias_rad_s + shared.segment<3>(SharedGyroBias);
  const Vector3d misalignment = state.misalignment_rad + shared.segment<3>(SharedSunSensor);
  std::vector<double> all;
  const auto add = [&](const Vector3d& residual) {
    all.insert(all.end(), residual.begin(), residual.end());
  };
  for (std::size_t i = 0; i < chain.turns.size(); ++i) {
    const Turn& turn = chain.turns[i];
    const Quaterniond turned =
        turn.turn * quaternion_by(turn.per_bias_s * (bias - chain.bias_rad_s) +
                                  turn.per_gyro_error * shared.segment<9>(SharedGyro));
    const Matrix3d whitening = turn.covariance_rad2.inverse().llt().matrixU();
    add(whitening * rotation_vector_of(turned.conjugate() * q(i).conjugate() * q(i + 1)));
  }
  // A late stamp shows where the body was before.
  const auto earlier = [&](const auto& sample, int time_error) {
    return q(sample.node) * quaternion_by(-shared[time_error] * sample.rate_body_rad_s);
  };
  for (const ChainSun& sun : chain.sun) {
    const Vector3d predicted =
        quaternion_by(misalignment) * (earlier(sun, SharedSunTime).conjugate() * sun.of.sun_icrf);
    add((predicted - sun.of.measured_body) / chain.noise.sun_rad);
  }
  // v_measured = exp(mounting error) v_true.
  for (const ChainStar& star : chain.stars) {
    const Quaterniond predicted =
        earlier(star, SharedStarTime) * quaternion_by(-shared.segment<3>(SharedStarTracker));
    add(rotation_vector_of(star.of.q_icrf_body.conjugate() * predicted) / chain.noise.star_rad);
  }
  return Eigen::Map<VectorXd>{all.data(), static_cast<Eigen::Index>(all.size())};
}

/// The whole problem at once: derivatives of all whitened residuals of the samples.
struct Dense {
  explicit Dense(const Chain& chain, const ChainState& state)
      : nodes{3 * static_cast<Eigen::Index>(state.q_icrf_body.size())} {
    constexpr double kStep = 1e-6;
    const Eigen::Index unknowns = nodes + kSharedErrors;
    residuals = residuals_at(chain, state, VectorXd::Zero(unknowns));
    slopes = MatrixXd(residuals.size(), unknowns);
    for (Eigen::Index i = 0; i < unknowns; ++i) {
      const VectorXd step = kStep * VectorXd::Unit(unknowns, i);
      slopes.col(i) =
          (residuals_at(chain, state, step) - residuals_at(chain, state, -step)) / (2.0 * kStep);
    }
  }

  Eigen::Index nodes;
  VectorXd residuals;
  MatrixXd slopes;
};

MatrixXd node_covariance(const ChainInformation& known, std::size_t node,
                         const SharedCovariance& shared) {
  return known.own_rad2[node] +
         known.per_shared[node] * shared * known.per_shared[node].transpose();
}

/// The estimator is the least-squares one of nodes, bias and misalignment. Its error is what its
/// gain makes of the noise of the samples, of the priors and of the errors that it leaves out.
TEST(Chain, ErrorsOfTheFitAreThoseOfTheWholeProblemAtOnce) {
  const Chain chain = chain_with(with(file_errors()));
  const ChainState state = started_at(chain, chain.stars.front());
  const Dense dense{chain, state};
  const Eigen::Index estimated = dense.nodes + kEstimatedErrors;
  const Eigen::Index considered = kSharedErrors - kEstimatedErrors;
  const MatrixXd slopes = dense.slopes.leftCols(estimated);
  MatrixXd prior = MatrixXd::Zero(estimated, estimated);
  const auto of = [&](int shared) { return dense.nodes + shared; };
  prior.diagonal().segment<3>(of(SharedGyroBias)).setConstant(std::pow(chain.noise.bias_rad_s, -2));
  prior.block<3, 3>(of(SharedSunSensor), of(SharedSunSensor)) = chain.noise.on_misalignment();
  const MatrixXd left = (slopes.transpose() * slopes + prior).inverse();
  const MatrixXd gain = left * slopes.transpose();
  MatrixXd follow(estimated, kSharedErrors);
  follow << left * prior.rightCols(kEstimatedErrors), -gain * dense.slopes.rightCols(considered);
  const auto total_with = [&](const AttitudeAlignment& alignment) -> MatrixXd {
    return gain * gain.transpose() +
           follow * prior_of(chain.noise.bias_rad_s, alignment) * follow.transpose();
  };
  const MatrixXd total = total_with(chain.noise.alignment);
  const MatrixXd noise = total_with(AttitudeAlignment::Zero());

  const ChainInformation known = information_of(chain, state);
  const SharedErrors found = errors_of(known, chain.noise);
  for (std::size_t i = 0; i < state.q_icrf_body.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const Matrix3d node = total.block<3, 3>(at, at);
    const Matrix3d node_noise = noise.block<3, 3>(at, at);
    EXPECT_LT((node_covariance(known, i, found.total) - node).norm(), 1e-4 * node.norm()) << i;
    const auto slopes_noise = known.per_shared[i].leftCols<kEstimatedErrors>();
    const Matrix3d found_noise =
        known.own_rad2[i] + slopes_noise * found.noise * slopes_noise.transpose();
    EXPECT_LT((found_noise - node_noise).norm(), 1e-4 * node_noise.norm()) << i;
  }
  const auto expect_same = [&](const MatrixXd& one, const MatrixXd& other) {
    const MatrixXd expected = other.bottomRightCorner(kEstimatedErrors, kEstimatedErrors);
    const MatrixXd scale = expected.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
    EXPECT_LT((scale * (one - expected) * scale).norm(), 1e-4);
  };
  expect_same(found.total.topLeftCorner(kEstimatedErrors, kEstimatedErrors), total);
  expect_same(found.noise, noise);
  EXPECT_GT(total.trace(), 2.0 * noise.trace());
}

TEST(Chain, LeastErrorsAreThoseOfAnEstimateOfEverything) {
  const Chain chain = chain_with(with(file_errors()));
  const ChainState state = started_at(chain, chain.stars.front());
  const Dense dense{chain, state};
  MatrixXd information = dense.slopes.transpose() * dense.slopes;
  information.bottomRightCorner<kSharedErrors, kSharedErrors>() += chain.noise.prior().inverse();
  const MatrixXd expected = information.inverse();
  const ChainInformation known = information_of(chain, state);
  const SharedCovariance found = least_errors_of(known, chain.noise);
  const SharedErrors of_fit = errors_of(known, chain.noise);
  for (std::size_t i = 0; i < state.q_icrf_body.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const Matrix3d node = expected.block<3, 3>(at, at);
    EXPECT_LT((node_covariance(known, i, found) - node).norm(), 1e-4 * node.norm()) << i;
    EXPECT_LT(node.trace(), node_covariance(known, i, of_fit.total).trace());
  }
}

/// Nothing but the bias is estimated, and nothing else is uncertain.
TEST(Chain, ErrorsOfAnExactMissionFileAreNoise) {
  const Chain chain = chain_with(kExact);
  const ChainState state = started_at(chain, chain.stars.front());
  const Dense dense{chain, state};
  MatrixXd slopes(dense.slopes.rows(), dense.nodes + 3);
  slopes << dense.slopes.leftCols(dense.nodes),
      dense.slopes.middleCols<3>(dense.nodes + SharedGyroBias);
  MatrixXd information = slopes.transpose() * slopes;
  information.diagonal().tail<3>().array() += std::pow(kExact.bias_rad_s, -2);
  const MatrixXd expected = information.inverse();
  const ChainInformation known = information_of(chain, state);
  const SharedErrors found = errors_of(known, chain.noise);
  EXPECT_EQ((found.total.topLeftCorner<kEstimatedErrors, kEstimatedErrors>()), found.noise);
  for (std::size_t i = 0; i < state.q_icrf_body.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const Matrix3d node = expected.block<3, 3>(at, at);
    EXPECT_LT((node_covariance(known, i, found.total) - node).norm(), 1e-4 * node.norm()) << i;
  }
}

/// The fit leaves residuals because the mission file is off; the errors that explain them are found
/// where the whole problem with all priors is solved at once.
TEST(Chain, ErrorsOfTheMissionFileAreFittedToWhatTheFitLeaves) {
  Chain chain = chain_with(with(file_errors()));
  const Vector3d mounting_rad{6e-3, -4e-3, 2e-3};
  chain.stars.front().of.q_icrf_body =
      chain.stars.front().of.q_icrf_body * quaternion_by(mounting_rad);
  for (ChainSun& sun : chain.sun) {
    sun.of.measured_body = quaternion_by({0.01, -0.02, 0.005}) * sun.of.measured_body;
  }
  const ChainState state =
      value_or_throw(fit(chain, started_at(chain, chain.stars.front()), SunLoss::Near)).state;
  const Dense dense{chain, state};
  SharedVector at = SharedVector::Zero();
  at.segment<3>(SharedGyroBias) = state.bias_rad_s;
  at.segment<3>(SharedSunSensor) = state.misalignment_rad;
  const SharedCovariance on_prior = chain.noise.prior().inverse();
  MatrixXd information = dense.slopes.transpose() * dense.slopes;
  VectorXd score = -dense.slopes.transpose() * dense.residuals;
  information.bottomRightCorner<kSharedErrors, kSharedErrors>() += on_prior;
  score.tail<kSharedErrors>() -= on_prior * at;
  const VectorXd moved = information.ldlt().solve(score);
  const VectorXd expected = dense.residuals + dense.slopes * moved;

  const ChainInformation known = information_of(chain, state);
  const FittedFile found = fitted_file(known, chain.noise, state);
  Eigen::Index row = 3 * static_cast<Eigen::Index>(chain.turns.size());
  for (const ChainSun& sun : chain.sun) {
    const Vector3d left =
        left_of(residual_of(sun, state), known.per_shared[sun.node], found.change);
    EXPECT_LT((left / chain.noise.sun_rad - expected.segment<3>(row)).norm(), 0.02);
    row += 3;
  }
  for (const ChainStar& star : chain.stars) {
    const Vector3d left =
        left_of(residual_of(star, state), known.per_shared[star.node], found.change);
    EXPECT_LT((left / chain.noise.star_rad - expected.segment<3>(row)).norm(), 0.02);
    row += 3;
  }
  EXPECT_GT((dense.residuals - expected).norm(), 0.2);

  const NormalEquations said = normal_equations(known, chain.noise, state, TaiTime{});
  ASSERT_EQ(said.names.size(), std::size_t{kFileErrors});
  EXPECT_EQ(said.names.front(), "sun_sensor_x_deg");
  VectorXd units{kFileErrors};
  std::ranges::transform(kOfAlignment, units.begin(), [](int error) {
    return kAttitudeAlignmentNames.at(static_cast<std::size_t>(error)).unit;
  });
  const MatrixXd of_file = units.asDiagonal() * on_prior(kOfFile, kOfFile) * units.asDiagonal();
  const VectorXd best = units.cwiseProduct((of_file + said.n).ldlt().solve(said.g));
  const VectorXd errors = (at + moved.tail<kSharedErrors>())(kOfFile);
  EXPECT_LT((best - errors).norm(), 1e-2 * errors.norm());
}

TEST(Chain, CovarianceOfAGyroWithoutNoiseIsThatOfTheStarFixes) {
  Chain chain = chain_with({.sun_rad = 1.0, .star_rad = 1e-4, .bias_rad_s = 1e-12});
  for (Turn& turn : chain.turns) {
    turn.covariance_rad2 *= 1e-24;
  }
  const ChainInformation known = information_of(chain, started_at(chain, chain.stars.front()));
  const SharedErrors found = errors_of(known, chain.noise);
  for (std::size_t i = 0; i < chain.times_s.size(); ++i) {
    EXPECT_NEAR(node_covariance(known, i, found.total).trace(), 3.0 * 0.5e-8, 1e-12);
  }
}

TEST(Chain, FitFindsAttitudesAndBiasFromFarOff) {
  const Vector3d bias_rad_s{2e-3, -1e-3, 1.5e-3};
  const Chain chain = chain_with(kExact, bias_rad_s);
  ChainState start = started_at(chain, chain.stars.front());
  for (Quaterniond& q : start.q_icrf_body) {
    q = q * quaternion_by({0.3, -0.2, 0.25});
  }
  const auto found = value_or_throw(fit(chain, start, SunLoss::Far));
  // The prior pulls the bias slightly towards zero.
  EXPECT_LT((found.state.bias_rad_s - bias_rad_s).norm(), 0.02 * bias_rad_s.norm());
  const ChainStar& star = chain.stars.front();
  EXPECT_LT(angle_between_rad(found.state.q_icrf_body[star.node], star.of.q_icrf_body),
            0.2 * kExact.star_rad);
}

/// Intervals may be as short as the rounding of times, too short to determine gyro noise.
TEST(Chain, FitConvergesWhateverTheTimeBetweenSamples) {
  const Vector3d bias_rad_s{2e-3, -1e-3, 1.5e-3};
  const auto bias_of = [&](const std::vector<double>& sun_times_s) -> Vector3d {
    const Chain chain = chain_with(with(of_sun_sensor(0.02)), bias_rad_s, sun_times_s);
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
