#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>
#include <ceres/types.h>
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"
#include "pipelines/reconstruction/chain_solution.h"
#include "pipelines/reconstruction/history.h"
#include "pipelines/reconstruction/methods.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction_assessment.h"
#include "pipelines/reconstruction/rotation_slopes.h"
#include "pipelines/reconstruction/star_consensus.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Disables the other convergence tests, which would end a slow body's step before it is solved.
constexpr double kNoTolerance = 1e-14;

/// The kinematic equation of one step; its parameter is the earlier attitude. Li 2017 writes it in
/// Euler angles with the rate at the later instant, which is singular at phi = 90 deg and off by
/// half the change of the rate. Here the turn of the step is used.
class StepCost final : public ceres::SizedCostFunction<3, 4> {
 public:
  StepCost(Quaterniond later, Quaterniond turn)
      : later_{std::move(later)}, turn_{std::move(turn)} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    const Quaterniond earlier = quaternion_at(at[0]);
    const Quaterniond turned = earlier.conjugate() * later_;
    const Vector3d off_rad = rotation_vector_of(turn_.conjugate() * turned);
    Eigen::Map<Vector3d>{residual} = off_rad;
    if (jacobians != nullptr) {
      write_slopes(-inverse_right_jacobian(off_rad) * turned.toRotationMatrix().transpose(),
                   earlier, jacobians[0]);
    }
    return true;
  }

 private:
  Quaterniond later_;
  Quaterniond turn_;
};

/// The equation A S_icrf = s_measured; its parameter is the attitude. Turns about the Sun are free.
class SunCorrection final : public ceres::SizedCostFunction<3, 4> {
 public:
  explicit SunCorrection(const SunObservation& sun) : sun_{&sun} {}

  bool Evaluate(double const* const* at, double* residual, double** jacobians) const override {
    const Quaterniond q = quaternion_at(at[0]);
    const Vector3d predicted = q.conjugate() * sun_->sun_icrf;
    Eigen::Map<Vector3d>{residual} = predicted - sun_->measured_body;
    if (jacobians != nullptr) {
      write_slopes(cross_matrix(predicted), q, jacobians[0]);
    }
    return true;
  }

 private:
  const SunObservation* sun_;
};

struct Solver {
  ceres::Solver::Options options;
  ceres::EigenQuaternionManifold manifold;
  int iterations = 0;

  explicit Solver(ceres::TrustRegionStrategyType strategy) {
    options.trust_region_strategy_type = strategy;
    options.linear_solver_type = ceres::DENSE_QR;
    options.num_threads = 1;
    // Equal weights for all axes, because a correction must not rotate about the Sun line.
    options.jacobi_scaling = false;
    options.min_lm_diagonal = 1.0;
    options.max_lm_diagonal = 1.0;
    // Relative tolerance of the cost between iterations, as in Li 2017.
    options.function_tolerance = 1e-6;
    options.gradient_tolerance = kNoTolerance;
    options.parameter_tolerance = kNoTolerance;
    options.logging_type = ceres::SILENT;
  }

  bool solve(ceres::CostFunction& cost, Quaterniond& q) {
    ceres::Problem::Options keeping;
    keeping.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    keeping.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem{keeping};
    problem.AddParameterBlock(q.coeffs().data(), 4, &manifold);
    problem.AddResidualBlock(&cost, nullptr, q.coeffs().data());
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    iterations += static_cast<int>(summary.iterations.size());
    return summary.IsSolutionUsable();
  }
};

/// Holds the attitude during backward propagation, with its error: an own one, and the shared
/// errors times their derivative. None of the shared errors is estimated, not even the bias.
class Backwards {
 public:
  Backwards(const StarObservation& star, const Eigen::Vector3d& rate_body_rad_s,
            const ThreeAxisConfig& sensors)
      : q_{star.q_icrf_body},
        own_rad2_{std::pow(sensors.star_tracker->noise_rad, 2) * Matrix3d::Identity()},
        shared_{prior_of(sensors.gyro->bias_sigma_rad_s, sensors.alignment)} {
    per_shared_.middleCols<3>(SharedStarTracker).setIdentity();
    per_shared_.col(SharedStarTime) = rate_body_rad_s;
  }

  bool step(const Turn& turn) {
    const Quaterniond later = q_;
    StepCost cost{later, turn.turn};
    const bool solved = dogleg_.solve(cost, q_);
    const Matrix3d turned = turn.turn.toRotationMatrix();
    own_rad2_ = turned * (own_rad2_ + turn.covariance_rad2) * turned.transpose();
    per_shared_.middleCols<kTurnErrors>(SharedGyroBias) -= turn.per_error();
    per_shared_ = turned * per_shared_;
    return solved;
  }

  /// Propagates forwards, from the star fix to a later instant.
  void turn_on(const Turn& turn) {
    q_ = (q_ * turn.turn).normalized();
    const Matrix3d back = turn.turn.toRotationMatrix().transpose();
    own_rad2_ = back * own_rad2_ * back.transpose() + turn.covariance_rad2;
    per_shared_ = back * per_shared_;
    per_shared_.middleCols<kTurnErrors>(SharedGyroBias) += turn.per_error();
  }

  /// Gates a sun vector against the current total covariance and returns its observation.
  Observation observe(const Observations& all, const SunObservation& sun, double noise_rad) const {
    const Vector3d predicted = q_.conjugate() * sun.sun_icrf;
    const Matrix3d slopes = cross_matrix(predicted);
    const PerShared turned = per_shared_ - per_shared_of(all, sun);
    const Matrix3d covariance =
        slopes * (own_rad2_ + turned * shared_ * turned.transpose()) * slopes.transpose() +
        noise_rad * noise_rad * Matrix3d::Identity();
    Observation said = sun_observation(all, sun, sun.measured_body - predicted, covariance);
    said.limit = innovation_gate(2);
    if (said.nis > said.limit) {
      said.rejected_by = Rejection::Innovation;
    }
    return said;
  }

  bool correct(const Observations& all, const SunObservation& sun, double noise_rad) {
    SunCorrection cost{sun};
    const bool solved = levenberg_marquardt_.solve(cost, q_);
    const Matrix3d along = sun.measured_body * sun.measured_body.transpose();
    const Matrix3d across = Matrix3d::Identity() - along;
    own_rad2_ = along * own_rad2_ * along.transpose() + noise_rad * noise_rad * across;
    per_shared_ = along * per_shared_ + across * per_shared_of(all, sun);
    return solved;
  }

  const Quaterniond& q() const { return q_; }
  const Matrix3d& own_rad2() const { return own_rad2_; }
  const PerShared& per_shared() const { return per_shared_; }
  int iterations() const { return dogleg_.iterations + levenberg_marquardt_.iterations; }

 private:
  /// Returns the derivative of the turn by which the sun sensor's errors turn a sun vector.
  static PerShared per_shared_of(const Observations& all, const SunObservation& sun) {
    PerShared slopes = PerShared::Zero();
    slopes.middleCols<3>(SharedSunSensor).setIdentity();
    slopes.col(SharedSunTime) = all.rates.rate_at(sun.t_s);
    return slopes;
  }

  Quaterniond q_;
  Matrix3d own_rad2_;
  PerShared per_shared_ = PerShared::Zero();
  SharedCovariance shared_;
  Solver dogleg_{ceres::DOGLEG};
  Solver levenberg_marquardt_{ceres::LEVENBERG_MARQUARDT};
};

/// Returns the times of every gyro sample, sun vector and event up to T4.
std::vector<double> step_times(const Observations& all, double last_s) {
  std::vector<double> times_s;
  for (const EventTime& event : all.events) {
    times_s.push_back(all.seconds_of(event.t));
  }
  for (const TimedRate& sample : all.rates.samples()) {
    times_s.push_back(sample.t_s);
  }
  for (const SunObservation& sun : all.sun) {
    times_s.push_back(sun.t_s);
  }
  std::erase_if(times_s, [=](double t_s) { return t_s < 0.0 || t_s > last_s; });
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  return times_s;
}

/// Returns the accepted star fix closest to T4.
const StarObservation& anchor(const std::vector<StarObservation>& stars, double last_s) {
  return *std::min_element(stars.begin(), stars.end(), [=](const auto& a, const auto& b) {
    return std::abs(a.t_s - last_s) < std::abs(b.t_s - last_s);
  });
}

/// Propagates from the star fix to T4 if they differ.
void turn_to(Backwards& at, const RateTrack& rates, double from_s, double to_s) {
  if (from_s > to_s) {
    at.step(rates.turns(std::vector{to_s, from_s}, Vector3d::Zero()).front());
  } else if (from_s < to_s) {
    at.turn_on(rates.turns(std::vector{from_s, to_s}, Vector3d::Zero()).front());
  }
}

Error not_solved(const Observations& all, double t_s) {
  return {ErrorCode::Unobservable,
          fmt::format("no attitude solves the kinematic equation {:.3f} s behind T2, at {} ns TAI",
                      t_s, tai_ns(shifted(all.origin, t_s)))};
}

struct Pass {
  NodeEstimates nodes;
  SensorResiduals sun;
  std::vector<Observation> said;  ///< Observations of the sun vectors, latest first.
  int iterations;
};

Expected<Pass> backwards(const ReconstructionRequest& request, const Observations& all,
                         const StarObservation& star, double louder_sun) {
  const double sun_noise_rad =
      all.sun.empty() ? 0.0 : louder_sun * request.sensors.sun_sensor->noise_rad;
  const double last_s = all.seconds_of(all.events.back().t);
  const std::vector<double> times_s = step_times(all, last_s);
  const std::vector<Turn> turns = all.rates.turns(times_s, Vector3d::Zero());
  Backwards at{star, all.rates.rate_at(star.t_s), request.sensors};
  turn_to(at, all.rates, star.t_s, last_s);
  const double bias_sigma_rad_s = request.sensors.gyro->bias_sigma_rad_s;
  const SharedCovariance exact = prior_of(bias_sigma_rad_s, AttitudeAlignment::Zero());
  Pass pass{
      .nodes = {.times_s = times_s,
                .q_icrf_body = {at.q()},
                .own_rad2 = {at.own_rad2()},
                .per_shared = {at.per_shared()},
                .bias_rad_s = Vector3d::Zero(),
                .shared = {.total = prior_of(bias_sigma_rad_s, request.sensors.alignment),
                           .noise = exact.topLeftCorner<kEstimatedErrors, kEstimatedErrors>()},
                .gyro_noise_rad_s = all.gyro_noise_rad_s},
      .sun = {},
      .said = {},
      .iterations = 0};
  auto sun = std::find_if(all.sun.rbegin(), all.sun.rend(),
                          [=](const SunObservation& one) { return one.t_s < last_s; });
  for (std::size_t i = turns.size(); i-- > 0;) {
    if (!at.step(turns[i])) {
      return Unexpected{not_solved(all, times_s[i])};
    }
    for (; sun != all.sun.rend() && sun->t_s == times_s[i]; ++sun) {
      const Observation said = at.observe(all, *sun, sun_noise_rad);
      pass.said.push_back(said);
      (said.rejected_by ? pass.sun.outliers : pass.sun.count) += 1;
      if (!said.rejected_by && !at.correct(all, *sun, sun_noise_rad)) {
        return Unexpected{not_solved(all, times_s[i])};
      }
    }
    pass.nodes.q_icrf_body.emplace_back(at.q());
    pass.nodes.own_rad2.emplace_back(at.own_rad2());
    pass.nodes.per_shared.emplace_back(at.per_shared());
  }
  std::reverse(pass.nodes.q_icrf_body.begin(), pass.nodes.q_icrf_body.end());
  std::reverse(pass.nodes.own_rad2.begin(), pass.nodes.own_rad2.end());
  std::reverse(pass.nodes.per_shared.begin(), pass.nodes.per_shared.end());
  pass.iterations = at.iterations();
  return pass;
}

}  // namespace

Expected<Reconstruction> reconstruct_sequential(const ReconstructionRequest& request,
                                                const Observations& all) {
  const GyroSensor& gyro = *request.sensors.gyro;
  const StarConsensus stars =
      consensus_of(all, all.stars,
                   {.star_rad = request.sensors.star_tracker->noise_rad,
                    .bias_rad_s = Vector3d::Zero(),
                    .shared = prior_of(gyro.bias_sigma_rad_s, request.sensors.alignment)});
  const double last_s = all.seconds_of(all.events.back().t);
  const StarObservation& star = anchor(stars.accepted, last_s);
  const CoarseFindings coarse = all.sun.empty() ? CoarseFindings{} : coarse_findings(request, all);
  const auto pass = backwards(request, all, star, coarse.louder_sun);
  if (!pass) {
    return Unexpected{pass.error()};
  }
  History history = history_of(request, all, pass->nodes);
  std::vector<Observation> said{pass->said.rbegin(), pass->said.rend()};
  const TaiTime anchored = shifted(all.origin, star.t_s);
  std::copy_if(stars.said.begin(), stars.said.end(), std::back_inserter(said),
               [=](const Observation& one) { return one.rejected_by || one.t == anchored; });
  add_gyro_left_out(all, said);
  Reconstruction result{.method = ReconstructionMethod::Sequential,
                        .events = events_of(all, history),
                        .history = std::move(history.attitudes),
                        .bias = std::nullopt,
                        .misalignment = std::nullopt,
                        .open_bias = {},
                        .gyro = gyro_residuals(all),
                        .sun = pass->sun,
                        .star = {.count = 1, .outliers = std::ssize(stars.gated())},
                        .said = std::move(said),
                        .assessment = {},
                        .iterations = pass->iterations};
  result.assessment = assess(request, all, result, stars, coarse.file);
  return result;
}

}  // namespace spindrift
