#include "pipelines/reconstruction/chain_fit.h"

#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>
#include <ceres/types.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <iterator>
#include <utility>
#include <vector>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/rotation_slopes.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Jacobian = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

constexpr int kMostIterations = 100;
constexpr double kFullWeight = 16.0;  ///< Squared deviation, in sigmas squared.
constexpr double kNoWeight = 64.0;

class NearLoss final : public ceres::LossFunction {
 public:
  explicit NearLoss(double allowed) : allowed_{allowed} {}

  void Evaluate(double squares, double* rho) const override {
    constexpr double kSpan = kNoWeight - kFullWeight;
    const double scaled = squares / allowed_;
    const double left = std::clamp((kNoWeight - scaled) / kSpan, 0.0, 1.0);
    rho[0] = allowed_ * (std::min(scaled, kFullWeight) + kSpan * (1.0 - left * left * left) / 3.0);
    rho[1] = weight_of(scaled);
    rho[2] = left < 1.0 ? -2.0 * left / kSpan / allowed_ : 0.0;
  }

 private:
  double allowed_;
};

void write_vector_slopes(const Matrix3d& slopes, double* jacobian) {
  if (jacobian != nullptr) {
    Jacobian{jacobian} = slopes;
  }
}

/// Parameters: earlier and later attitude (quaternions, x y z w), bias in rad/s.
class GyroCost final : public ceres::SizedCostFunction<3, 4, 4, 3> {
 public:
  GyroCost(const Turn& turn, Vector3d bias_rad_s)
      : turn_{&turn},
        bias_rad_s_{std::move(bias_rad_s)},
        whitening_{turn.covariance_rad2.llt().matrixL().solve(Matrix3d::Identity())} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    const Quaterniond earlier = quaternion_at(at[0]);
    const Quaterniond later = quaternion_at(at[1]);
    const Vector3d correction_rad =
        turn_->per_bias_s * (Eigen::Map<const Vector3d>{at[2]} - bias_rad_s_);
    const Quaterniond turned = earlier.conjugate() * later;
    const Vector3d off_rad =
        rotation_vector_of(quaternion_by(-correction_rad) * (turn_->turn.conjugate() * turned));
    Eigen::Map<Vector3d>{residual} = whitening_ * off_rad;
    if (jacobians != nullptr) {
      const Matrix3d inverse = inverse_right_jacobian(off_rad);
      const Matrix3d slopes = whitening_ * inverse;
      write_slopes(-slopes * turned.toRotationMatrix().transpose(), earlier, jacobians[0]);
      write_slopes(slopes, later, jacobians[1]);
      write_vector_slopes(
          -whitening_ * inverse.transpose() * right_jacobian(correction_rad) * turn_->per_bias_s,
          jacobians[2]);
    }
    return true;
  }

 private:
  const Turn* turn_;
  Vector3d bias_rad_s_;
  Matrix3d whitening_;
};

class SunCost final : public ceres::SizedCostFunction<3, 4, 3> {
 public:
  SunCost(const SunObservation& sun, double noise_rad) : sun_{&sun}, noise_rad_{noise_rad} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    const Quaterniond q = quaternion_at(at[0]);
    const Vector3d misalignment_rad = Eigen::Map<const Vector3d>{at[1]};
    const Matrix3d aligned = quaternion_by(misalignment_rad).toRotationMatrix();
    const Vector3d sun_body = q.conjugate() * sun_->sun_icrf;
    const Vector3d predicted = aligned * sun_body;
    Eigen::Map<Vector3d>{residual} = (predicted - sun_->measured_body) / noise_rad_;
    if (jacobians != nullptr) {
      write_slopes(aligned * cross_matrix(sun_body) / noise_rad_, q, jacobians[0]);
      write_vector_slopes(
          -cross_matrix(predicted) * right_jacobian(misalignment_rad).transpose() / noise_rad_,
          jacobians[1]);
    }
    return true;
  }

 private:
  const SunObservation* sun_;
  double noise_rad_;
};

class StarCost final : public ceres::SizedCostFunction<3, 4> {
 public:
  StarCost(const StarObservation& star, double noise_rad) : star_{&star}, noise_rad_{noise_rad} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    const Quaterniond q = quaternion_at(at[0]);
    const Vector3d off_rad = rotation_vector_of(star_->q_icrf_body.conjugate() * q);
    Eigen::Map<Vector3d>{residual} = off_rad / noise_rad_;
    if (jacobians != nullptr) {
      write_slopes(inverse_right_jacobian(off_rad) / noise_rad_, q, jacobians[0]);
    }
    return true;
  }

 private:
  const StarObservation* star_;
  double noise_rad_;
};

/// The prior of a parameter with zero mean.
class PriorCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit PriorCost(const Matrix3d& information) : whitening_{information.llt().matrixU()} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    Eigen::Map<Vector3d>{residual} = whitening_ * Eigen::Map<const Vector3d>{at[0]};
    if (jacobians != nullptr) {
      write_vector_slopes(whitening_, jacobians[0]);
    }
    return true;
  }

 private:
  Matrix3d whitening_;
};

/// Owns the cost and loss functions to which the Ceres problem points.
class ChainProblem {
 public:
  ChainProblem(const Chain& chain, ChainState& state, SunLoss loss)
      : problem_{keeping()},
        bias_prior_{std::pow(chain.noise.bias_rad_s, -2) * Matrix3d::Identity()},
        misalignment_prior_{chain.noise.on_misalignment()} {
    const auto loss_of = [&](const ChainSun& sun) -> ceres::LossFunction* {
      return loss == SunLoss::Far
                 ? &far_
                 : static_cast<ceres::LossFunction*>(&near_.emplace_back(sun.allowed));
    };
    double* const bias = state.bias_rad_s.data();
    double* const misalignment = state.misalignment_rad.data();
    const auto q = [&](std::size_t node) { return state.q_icrf_body[node].coeffs().data(); };
    for (std::size_t i = 0; i < state.q_icrf_body.size(); ++i) {
      problem_.AddParameterBlock(q(i), 4, &manifold_);
    }
    for (std::size_t i = 0; i < chain.turns.size(); ++i) {
      GyroCost& cost = gyro_.emplace_back(chain.turns[i], chain.bias_rad_s);
      problem_.AddResidualBlock(&cost, nullptr, q(i), q(i + 1), bias);
    }
    for (const ChainSun& sun : chain.sun) {
      SunCost& cost = sun_.emplace_back(sun.of, chain.noise.sun_rad);
      problem_.AddResidualBlock(&cost, loss_of(sun), q(sun.node), misalignment);
    }
    for (const ChainStar& star : chain.stars) {
      StarCost& cost = star_.emplace_back(star.of, chain.noise.star_rad);
      problem_.AddResidualBlock(&cost, nullptr, q(star.node));
    }
    problem_.AddResidualBlock(&bias_prior_, nullptr, bias);
    problem_.AddResidualBlock(&misalignment_prior_, nullptr, misalignment);
    if (!chain.noise.estimates_misalignment()) {
      problem_.SetParameterBlockConstant(misalignment);
    }
  }

  ceres::Problem& problem() { return problem_; }

 private:
  static ceres::Problem::Options keeping() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  /// The loss of the coarse solution is linear beyond 3 sigmas.
  ceres::HuberLoss far_{3.0};
  std::deque<NearLoss> near_;
  ceres::EigenQuaternionManifold manifold_;
  ceres::Problem problem_;
  std::deque<GyroCost> gyro_;
  std::deque<SunCost> sun_;
  std::deque<StarCost> star_;
  PriorCost bias_prior_;
  PriorCost misalignment_prior_;
};

struct Misfit {
  const char* sensor;
  double sigmas;  ///< Root mean square of a residual component.
  const char* check;
};

template <class Residuals, class Squares>
double rms(const Residuals& residuals, Squares squares_of) {
  double squares = 0.0;
  for (const auto& residual : residuals) {
    squares += squares_of(residual);
  }
  return residuals.empty()
             ? 0.0
             : std::sqrt(squares / (3.0 * static_cast<double>(std::ssize(residuals))));
}

Misfit worst(const Chain& chain, const ChainState& state) {
  std::vector<double> gyro_squares;
  for (std::size_t i = 0; i < chain.turns.size(); ++i) {
    const Turn& turn = chain.turns[i];
    const Vector3d off_rad = rotation_vector_of(
        turn.turn.conjugate() * (state.q_icrf_body[i].conjugate() * state.q_icrf_body[i + 1]));
    gyro_squares.push_back(off_rad.dot(turn.covariance_rad2.llt().solve(off_rad)));
  }
  const auto sun_squares = [&](const ChainSun& sun) {
    return (predicted_sun(state, sun) - sun.of.measured_body).squaredNorm() /
           (chain.noise.sun_rad * chain.noise.sun_rad);
  };
  const auto star_squares = [&](const ChainStar& star) {
    return std::pow(
        angle_between_rad(state.q_icrf_body[star.node], star.of.q_icrf_body) / chain.noise.star_rad,
        2);
  };
  const std::array<Misfit, 3> all{
      Misfit{"gyro", rms(gyro_squares, [](double squares) { return squares; }),
             "its unit, axes and noise"},
      Misfit{"sun sensor", rms(chain.sun, sun_squares), "its axes, its noise and the orbit"},
      Misfit{"star tracker", rms(chain.stars, star_squares), "its mounting, sign and noise"}};
  return *std::max_element(all.begin(), all.end(),
                           [](const Misfit& a, const Misfit& b) { return a.sigmas < b.sigmas; });
}

Error not_explained(const Chain& chain, const ChainState& state) {
  const Misfit misfit = worst(chain, state);
  return {ErrorCode::Unobservable,
          fmt::format("no attitude explains the samples within {} iterations; the {} is furthest "
                      "off, by {:.3g} of its sigmas: check {} in the mission file",
                      kMostIterations, misfit.sensor, misfit.sigmas, misfit.check)};
}

}  // namespace

double weight_of(double squares) {
  const double left = std::clamp((kNoWeight - squares) / (kNoWeight - kFullWeight), 0.0, 1.0);
  return left * left;
}

double weight_of(const ChainSun& sun, const Chain& chain, const ChainState& state) {
  const double squares = (predicted_sun(state, sun) - sun.of.measured_body).squaredNorm();
  return weight_of(squares / (sun.allowed * chain.noise.sun_rad * chain.noise.sun_rad));
}

double squares_of(double weight) {
  return kNoWeight - (kNoWeight - kFullWeight) * std::sqrt(weight);
}

Expected<ChainFit> fit(const Chain& chain, ChainState start, SunLoss loss) {
  ChainFit found{.state = std::move(start), .iterations = 0};
  ChainProblem problem{chain, found.state, loss};
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = kMostIterations;
  // The largest radius that Ceres accepts, which disables Levenberg-Marquardt damping. Damping ties
  // each attitude to its present value by a part of its weight and nearly stops a common rotation
  // of all nodes, which the links leave free.
  options.initial_trust_region_radius = 1e16;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem(), &summary);
  if (summary.termination_type != ceres::CONVERGENCE) {
    return Unexpected{not_explained(chain, found.state)};
  }
  found.iterations = static_cast<int>(summary.iterations.size());
  return found;
}

}  // namespace spindrift
