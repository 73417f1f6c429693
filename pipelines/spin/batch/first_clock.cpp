#include "pipelines/spin/batch/first_clock.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/edge_prediction.h"

namespace spindrift {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// So many tell a parabola to a fraction of a degree.
constexpr std::size_t kEnough = 4000;
// Edges that lie elsewhere are dropped, and the parabola is fitted again.
constexpr int kPasses = 6;

struct Counted {
  double part;       ///< Time from the middle of the pass, in half lengths.
  double phase_rad;  ///< Predicted, in the turn that the revolution has.
  std::int64_t revolution;
};

/// Sun1 begins a turn; edges of the same revolution follow within it, those of chords that straddle
/// the next one included.
double unwrapped_rad(double phase_rad, double phase_of_sun_rad, std::int64_t turns) {
  const double after_rad = wrapped_rad(phase_rad - phase_of_sun_rad);
  return static_cast<double>(turns) * kTurn_rad + phase_of_sun_rad +
         (after_rad < 0.0 ? after_rad + kTurn_rad : after_rad);
}

Eigen::Vector3d parabola(const std::vector<Counted>& counted) {
  Eigen::Matrix3d normal = 1e-12 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Counted& edge : counted) {
    const Eigen::Vector3d row{1.0, edge.part, edge.part * edge.part};
    normal += row * row.transpose();
    right += row * edge.phase_rad;
  }
  return normal.ldlt().solve(right);
}

}  // namespace

Expected<SpinState> first_state(const PassModel& model, std::span<const PassEdge> edges,
                                const Eigen::Vector3d& axis_icrf) {
  const auto q_icrf_spin = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis_icrf);
  const Eigen::Matrix3d R_spin_icrf = q_icrf_spin.conjugate().toRotationMatrix();
  const std::size_t stride = std::max<std::size_t>(edges.size() / kEnough, 1);
  const std::int64_t middle = edges[edges.size() / 2].revolution;
  std::vector<Counted> counted;
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const PassEdge& edge = edges[i];
    const Sky& sky = model.sky_at(edge.pulse.t);
    const auto predicted = predict_edge(model.config(), sky, R_spin_icrf, edge.pulse);
    if (predicted) {
      const Eigen::Vector3d sun_spin = R_spin_icrf * sky.sun_icrf;
      counted.push_back(
          {.part = seconds_between(model.middle(), edge.pulse.t) / model.half_s(),
           .phase_rad = unwrapped_rad(predicted->phase_rad, std::atan2(sun_spin.y(), sun_spin.x()),
                                      edge.revolution - middle),
           .revolution = edge.revolution});
    }
  }
  if (counted.empty()) {
    return Unexpected{
        {ErrorCode::Unobservable, "no edge is one that a body about the first axis would give"}};
  }
  Eigen::Vector3d clock = parabola(counted);
  for (int pass = 0; pass < kPasses; ++pass) {
    // An edge near sun1 may have been counted to the turn before or after.
    for (Counted& edge : counted) {
      const double off_rad =
          edge.phase_rad - (clock[0] + (clock[1] + clock[2] * edge.part) * edge.part);
      edge.phase_rad -=
          std::abs(off_rad) < 2.0 * kTurn_rad ? kTurn_rad * std::round(off_rad / kTurn_rad) : 0.0;
    }
    clock = parabola(counted);
  }
  return SpinState{.q_icrf_spin = q_icrf_spin * Eigen::Quaterniond{Eigen::AngleAxisd{
                                                    clock[0], Eigen::Vector3d::UnitZ()}},
                   .rate_rad_s = clock[1] / model.half_s(),
                   .drift_rad_s2 = 2.0 * clock[2] / (model.half_s() * model.half_s())};
}

}  // namespace spindrift
