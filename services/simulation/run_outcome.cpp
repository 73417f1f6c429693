#include "services/simulation/run_outcome.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <variant>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "services/base/degrees.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

class Measures {
 public:
  void add(std::string name, std::optional<double> value) {
    all_.push_back({std::move(name), value});
  }

  /// @param error_rad Empty: there is no solution.
  template <class Vector, class Covariance>
  void add_error(const std::string& of, const std::optional<Vector>& error_rad,
                 const Covariance& covariance_rad2) {
    add(of + "_error_deg",
        error_rad ? std::optional{kDegPerRad * error_rad->norm()} : std::nullopt);
    add(of + "_normalised_square",
        error_rad ? std::optional{error_rad->dot(covariance_rad2.ldlt().solve(*error_rad))}
                  : std::nullopt);
  }

  std::vector<Measure> all() && { return std::move(all_); }

 private:
  std::vector<Measure> all_;
};

/// Returns the small rotation from the solution to the truth, body axes.
Vector3d attitude_error_rad(const Eigen::Quaterniond& found, const Eigen::Quaterniond& truth) {
  return rotation_vector_of(found.conjugate() * truth);
}

/// Returns the error in the tangent plane at the found axis: east, north.
Eigen::Vector2d axis_error_rad(const Vector3d& found_icrf, const Vector3d& truth_icrf) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(found_icrf);
  const Vector3d across = truth_icrf - found_icrf.dot(truth_icrf) * found_icrf;
  const double angle_rad = angle_between_rad(found_icrf, truth_icrf);
  return across.norm() > 0.0 ? Eigen::Vector2d{angle_rad * basis.transpose() * across.normalized()}
                             : Eigen::Vector2d::Zero().eval();
}

void add_axes(const SpinScenario& flight, const RunSummary& summary, Measures& measures) {
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    const auto found = summary.estimates.find(estimator);
    std::optional<Eigen::Vector2d> error_rad;
    Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Identity();
    if (found != summary.estimates.end()) {
      error_rad = axis_error_rad(found->second.axis_icrf, flight.truth.motion.axis_icrf);
      covariance_rad2 = found->second.covariance_rad2;
    }
    measures.add_error(std::string{name_of(estimator)}, error_rad, covariance_rad2);
  }
}

void add_reconstruction(const SimulatedPass& pass, const RunSummary& summary,
                        ReconstructionMethod method, Measures& measures) {
  const auto& all = summary.reconstructions;
  const auto made = std::find_if(all.begin(), all.end(), [method](const auto& reconstruction) {
    return reconstruction->solution.method == method;
  });
  std::optional<Vector3d> error_rad;
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Identity();
  if (made != all.end()) {
    const ReconstructedAttitude& found = (*made)->solution.events.front().attitude;
    error_rad = attitude_error_rad(found.q_icrf_body, pass.motion->at(0.0).q_icrf_body);
    covariance_rad2 = found.covariance_rad2;
  }
  measures.add_error(fmt::format("{}_t1", name_of(method)), error_rad, covariance_rad2);
}

void add_attitude(const Scenario& scenario, const SimulatedPass& pass, const RunSummary& summary,
                  Measures& measures) {
  std::optional<Vector3d> error_rad;
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Identity();
  if (const auto& found = summary.attitude) {
    const double t_s = seconds_between(scenario.start, found->t);
    error_rad = attitude_error_rad(found->q_icrf_body, pass.motion->at(t_s).q_icrf_body);
    covariance_rad2 = found->covariance_rad2;
  }
  measures.add_error("attitude", error_rad, covariance_rad2);
}

void add_control(const SimulatedPass& pass, Measures& measures) {
  for (const char* const name :
       {"pointing_s", "settled_s", "last_off_deg", "wheel_nms_most", "wheel_rpm_most"}) {
    const auto& value = pass.truth[name];
    measures.add(name, value.is_number() ? std::optional{value.get<double>()} : std::nullopt);
  }
}

}  // namespace

std::vector<Measure> run_outcome(const Scenario& scenario, const SimulatedPass& pass,
                                 const RunSummary& summary) {
  Measures measures;
  if (const auto* const spin = std::get_if<SpinScenario>(&scenario.flight)) {
    add_axes(*spin, summary, measures);
    return std::move(measures).all();
  }
  if (std::holds_alternative<SeparationScenario>(scenario.flight)) {
    add_reconstruction(pass, summary, ReconstructionMethod::Batch, measures);
    add_reconstruction(pass, summary, ReconstructionMethod::Sequential, measures);
  }
  if (std::holds_alternative<OrientationScenario>(scenario.flight)) {
    add_control(pass, measures);
  }
  add_attitude(scenario, pass, summary, measures);
  return std::move(measures).all();
}

}  // namespace spindrift
