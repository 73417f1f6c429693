#include "pipelines/spin/batch/initial_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/edge_prediction.h"

namespace spindrift {
namespace {

// The first parabola is off by at most one turn from end to end, which is little within a span.
constexpr int kClockSpans = 64;

struct Counted {
  double part;       ///< Time from the middle of the pass, in half lengths.
  double phase_rad;  ///< Predicted phase, unwrapped by the revolution number.
};

/// Returns the phase unwrapped by revolutions: Sun1 begins a revolution and its other edges follow
/// within one turn, also those of chords that straddle the next Sun1.
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

double phase_at(const Eigen::Vector3d& clock, double part) {
  return clock[0] + (clock[1] + clock[2] * part) * part;
}

/// Corrects edges that were counted to the revolution before or after: the edges of each span
/// cluster at one phase, which moves little from one span to the next.
void count_anew(const Eigen::Vector3d& clock, std::vector<Counted>& counted) {
  std::array<std::complex<double>, kClockSpans> places{};
  const auto span_of = [](const Counted& edge) {
    const auto span = static_cast<int>(0.5 * (edge.part + 1.0) * kClockSpans);
    return static_cast<std::size_t>(std::clamp(span, 0, kClockSpans - 1));
  };
  for (const Counted& edge : counted) {
    places.at(span_of(edge)) += std::polar(1.0, edge.phase_rad - phase_at(clock, edge.part));
  }
  std::array<double, kClockSpans> place_rad{};
  double last_rad = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places.at(i) != 0.0) {
      last_rad += wrapped_rad(std::arg(places.at(i)) - last_rad);
    }
    place_rad.at(i) = last_rad;
  }
  for (Counted& edge : counted) {
    const double near_rad = phase_at(clock, edge.part) + place_rad.at(span_of(edge));
    edge.phase_rad = near_rad + wrapped_rad(edge.phase_rad - near_rad);
  }
}

}  // namespace

Expected<SpinState> initial_state(const PassModel& model, std::span<const PassEdge> edges,
                                  const Eigen::Vector3d& axis_icrf) {
  const Eigen::Quaterniond q_icrf_spin = frame_about(axis_icrf);
  const Eigen::Matrix3d R_spin_icrf = q_icrf_spin.conjugate().toRotationMatrix();
  const PlacedSensors sensors{model.config(), SensorBiases::Zero()};
  // This many edges determine a parabola to a fraction of a degree.
  const std::size_t stride = std::max<std::size_t>(edges.size() / 4000, 1);
  const std::int64_t middle = edges[edges.size() / 2].revolution;
  std::vector<Counted> counted;
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const PassEdge& edge = edges[i];
    const Sky& sky = model.sky_at(edge.pulse.t);
    const auto predicted = predict_edge(sensors, sky, R_spin_icrf, edge.pulse);
    if (predicted) {
      const Eigen::Vector3d sun_spin = R_spin_icrf * sky.sun_icrf;
      counted.push_back(
          {.part = seconds_between(model.middle(), edge.pulse.t) / model.half_s(),
           .phase_rad = unwrapped_rad(predicted->phase_rad, std::atan2(sun_spin.y(), sun_spin.x()),
                                      edge.revolution - middle)});
    }
  }
  if (counted.empty()) {
    return unobservable("no edge is one that a body about the first axis would give");
  }
  Eigen::Vector3d clock = parabola(counted);
  for (int pass = 0; pass < 3; ++pass) {
    count_anew(clock, counted);
    clock = parabola(counted);
  }
  return SpinState{.q_icrf_spin = q_icrf_spin * Eigen::Quaterniond{Eigen::AngleAxisd{
                                                    clock[0], Eigen::Vector3d::UnitZ()}},
                   .rate_rad_s = clock[1] / model.half_s(),
                   .drift_rad_s2 = 2.0 * clock[2] / (model.half_s() * model.half_s())};
}

}  // namespace spindrift
