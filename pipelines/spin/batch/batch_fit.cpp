#include "pipelines/spin/batch/batch_fit.h"

#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>
#include <ceres/types.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/spin/batch/nutation_stretch.h"
#include "pipelines/spin/batch/pass_information.h"

namespace spindrift {
namespace {

/// Holds the parameters of Ceres; rate and drift are changes since the start, as angles.
struct Parameters {
  Eigen::Quaterniond q_icrf_spin;
  Eigen::Vector2d clock = Eigen::Vector2d::Zero();
  SensorBiases biases;
  std::vector<NutationStretch> nutation;
  /// Constant dummy unknowns for edges outside any stretch.
  Eigen::Vector4d none = Eigen::Vector4d::Zero();
};

class Fit final : public ceres::EvaluationCallback {
 public:
  Fit(const PassModel& model, const SpinState& start)
      : model_{model},
        start_{start},
        parameters_{
            .q_icrf_spin = start.q_icrf_spin, .biases = start.biases, .nutation = start.nutation},
        here_{model.at(start)} {}

  SpinState state() const {
    const double half_s = model_.half_s();
    return {.q_icrf_spin = parameters_.q_icrf_spin,
            .rate_rad_s = start_.rate_rad_s + parameters_.clock[0] / half_s,
            .drift_rad_s2 = start_.drift_rad_s2 + 2.0 * parameters_.clock[1] / (half_s * half_s),
            .biases = parameters_.biases,
            .nutation = parameters_.nutation};
  }
  const PassModel& model() const { return model_; }
  Parameters& parameters() { return parameters_; }

  /// Ceres has written the new parameters; the work that all edges share is done once here.
  void PrepareForEvaluation(bool /*jacobians*/, bool new_point) override {
    if (new_point) {
      here_ = model_.at(state());
    }
  }
  const PassAtState& here() const { return here_; }

 private:
  const PassModel& model_;
  SpinState start_;
  Parameters parameters_;
  PassAtState here_;
};

/// Returns the Jacobian of the quaternion by half the rotation angles about the ICRF axes, which
/// are the steps of Ceres' manifold.
Eigen::Matrix<double, 4, 3> quaternion_per_turn(const Eigen::Quaterniond& q) {
  Eigen::Matrix<double, 4, 3> slopes;
  slopes << q.w(), q.z(), -q.y(),  //
      -q.z(), q.w(), q.x(),        //
      q.y(), -q.x(), q.w(),        //
      -q.x(), -q.y(), -q.z();
  return slopes;
}

class EdgeCost final : public ceres::SizedCostFunction<1, 4, 2, kSensorBiases, kNutationUnknowns> {
 public:
  EdgeCost(const Fit& fit, const Pulse& edge) : fit_{&fit}, edge_{edge} {}

  bool Evaluate(double const* const* /*at*/, double* residual, double** jacobians) const override {
    const PassAtState& here = fit_->here();
    const auto edge = here.residual(edge_);
    // An edge that the state does not predict counts as an outlier with zero slopes.
    residual[0] = edge ? edge->off : kOutlierSigmas;
    if (jacobians != nullptr) {
      write(edge.value_or(EdgeResidual{.off = 0.0, .slopes = EdgeSlopes::Zero()}),
            here.state().q_icrf_spin, jacobians);
    }
    return std::isfinite(residual[0]);
  }

 private:
  static void write(const EdgeResidual& edge, const Eigen::Quaterniond& q_icrf_spin,
                    double** jacobians) {
    const EdgeSlopes& slopes = edge.slopes;
    if (jacobians[0] != nullptr) {
      const Eigen::RowVector3d by_half_turn =
          2.0 * slopes.head<3>() * q_icrf_spin.conjugate().toRotationMatrix();
      Eigen::Map<Eigen::RowVector4d>{jacobians[0]} =
          by_half_turn * quaternion_per_turn(q_icrf_spin).transpose();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::RowVector2d>{jacobians[1]} = slopes.segment<2>(3);
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 1, kSensorBiases>>{jacobians[2]} =
          slopes.tail<kSensorBiases>();
    }
    if (jacobians[3] != nullptr) {
      Eigen::Map<NutationSlopes>{jacobians[3]} = edge.nutation_slopes;
    }
  }

  const Fit* fit_;
  Pulse edge_;
};

class PriorCost final : public ceres::SizedCostFunction<kSensorBiases, kSensorBiases> {
 public:
  explicit PriorCost(SensorBiases sigmas) : sigmas_{std::move(sigmas)} {}

  bool Evaluate(double const* const* at, double* residuals, double** jacobians) const override {
    for (int i = 0; i < kSensorBiases; ++i) {
      residuals[i] = at[0][i] / sigmas_[i];
      for (int j = 0; jacobians != nullptr && jacobians[0] != nullptr && j < kSensorBiases; ++j) {
        jacobians[0][i * kSensorBiases + j] = i == j ? 1.0 / sigmas_[i] : 0.0;
      }
    }
    return true;
  }

 private:
  SensorBiases sigmas_;
};

/// Holds the loss of each edge.
class Losses {
 public:
  /// Huber's loss, where edges beyond the limit of the fine fit must still pull.
  static Losses coarse() { return Losses{}; }
  /// Tukey's loss about a state near the best one, wider where the mission file may be off.
  static Losses fine(const PassAtState& near, const SpinAlignment& alignment) {
    Losses losses;
    losses.near_ = &near;
    losses.alignment_ = alignment;
    return losses;
  }

  ceres::LossFunction* of(const Pulse& edge) {
    if (near_ == nullptr) {
      return &huber_;
    }
    const auto residual = is_stated(alignment_) ? near_->residual(edge) : std::nullopt;
    return residual ? &wider_.emplace_back(kOutlierSigmas * residual->sigma(alignment_)) : &tukey_;
  }

 private:
  Losses() = default;

  ceres::HuberLoss huber_{3.0};
  ceres::TukeyLoss tukey_{kOutlierSigmas};
  std::deque<ceres::TukeyLoss> wider_;  // A deque keeps the addresses that Ceres holds.
  const PassAtState* near_ = nullptr;
  SpinAlignment alignment_ = SpinAlignment::Zero();
};

void hold_biases(ceres::Problem& problem, double* biases, BiasSet estimated) {
  std::vector<int> held;
  for (int i = 0; i < kSensorBiases; ++i) {
    if (!estimated[static_cast<std::size_t>(i)]) {
      held.push_back(i);
      continue;
    }
    const double bound = range_of(static_cast<SensorBias>(i)).bound;
    problem.SetParameterLowerBound(biases, i, -bound);
    problem.SetParameterUpperBound(biases, i, bound);
  }
  if (estimated.none()) {
    problem.SetParameterBlockConstant(biases);
  } else if (!held.empty()) {
    problem.SetManifold(biases, new ceres::SubsetManifold{kSensorBiases, held});
  }
}

void add_edges(Fit& fit, std::span<const PassEdge> edges, std::size_t stride, Losses& losses,
               std::deque<EdgeCost>& costs, ceres::Problem& problem) {
  Parameters& at = fit.parameters();
  auto stretch = at.nutation.begin();
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const Pulse& edge = edges[i].pulse;
    while (stretch != at.nutation.end() && stretch->end <= edge.t) {
      ++stretch;
    }
    const bool nutates = stretch != at.nutation.end() && stretch->holds(edge.t);
    EdgeCost& cost = costs.emplace_back(fit, edge);
    problem.AddResidualBlock(&cost, losses.of(edge), at.q_icrf_spin.coeffs().data(),
                             at.clock.data(), at.biases.data(),
                             nutates ? stretch->unknowns.data() : at.none.data());
  }
  if (problem.HasParameterBlock(at.none.data())) {
    problem.SetParameterBlockConstant(at.none.data());
  }
}

ceres::Solver::Summary solve(Fit& fit, std::span<const PassEdge> edges, std::size_t stride,
                             Losses& losses, BiasSet estimated) {
  ceres::Problem::Options keeping;
  keeping.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keeping.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keeping.disable_all_safety_checks = true;
  keeping.evaluation_callback = &fit;
  std::deque<EdgeCost> costs;  // A deque keeps the addresses that Ceres holds.
  PriorCost prior{BiasPriors{fit.model(), fit.state()}.of_estimated()};
  ceres::Problem problem{keeping};
  Parameters& at = fit.parameters();
  add_edges(fit, edges, stride, losses, costs, problem);
  problem.AddResidualBlock(&prior, nullptr, at.biases.data());
  problem.SetManifold(at.q_icrf_spin.coeffs().data(), new ceres::EigenQuaternionManifold);
  hold_biases(problem, at.biases.data(), estimated);

  ceres::Solver::Options options;
  // With several stretches the equations are sparse, as each stretch has its own unknowns.
  options.linear_solver_type =
      at.nutation.size() > 1 ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = 50;
  // At this tolerance the step not taken is at most an eighth of sigma for a pass of 150,000
  // revolutions, a hundredth of the actual error.
  options.function_tolerance = 2e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

BiasSet biases_at_bound(const SensorBiases& biases, BiasSet estimated) {
  BiasSet at_bound;
  for (int i = 0; i < kSensorBiases; ++i) {
    const double bound = range_of(static_cast<SensorBias>(i)).bound;
    at_bound[static_cast<std::size_t>(i)] =
        estimated[static_cast<std::size_t>(i)] && std::abs(biases[i]) > 0.999 * bound;
  }
  return at_bound;
}

}  // namespace

SpinState coarse_fit(const PassModel& model, std::span<const PassEdge> edges,
                     const SpinState& start, BiasSet estimated) {
  Fit fit{model, start};
  Losses losses = Losses::coarse();
  const std::size_t stride = std::max<std::size_t>(edges.size() / kCoarseEdges, 1);
  solve(fit, edges, stride, losses, estimated);
  return fit.state();
}

Expected<BatchFit> fit(const PassModel& model, std::span<const PassEdge> edges,
                       const SpinState& start, BiasSet estimated) {
  // A start with nutation is already the end of a fit, and a coarse fit would lose its frequency.
  Fit fit{model, start.nutation.empty() ? coarse_fit(model, edges, start, estimated) : start};
  const PassAtState near = model.at(fit.state());
  Losses losses = Losses::fine(near, model.config().alignment);
  const ceres::Solver::Summary summary = solve(fit, edges, 1, losses, estimated);
  if (!summary.IsSolutionUsable()) {
    return unobservable(
        fmt::format("no state of the body explains the edges: {}", summary.message));
  }
  const SpinState state = fit.state();
  return BatchFit{.state = state,
                  .at_bound = biases_at_bound(state.biases, estimated),
                  .iterations = static_cast<int>(summary.iterations.size())};
}

}  // namespace spindrift
