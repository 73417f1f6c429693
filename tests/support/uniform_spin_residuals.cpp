#include "tests/support/uniform_spin_residuals.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/coning.h"
#include "tests/support/observed_spin.h"
#include "tests/support/spin_truth.h"

namespace spindrift::testing {
namespace {

// Half the interval, s, over which one set of Sun and Earth directions is used.
constexpr double kSky_s = 30.0;

// Newton steps; the first moves the axis by at most a degree.
constexpr int kSteps = 4;

std::vector<TrueEdge> with_noise(std::vector<TrueEdge> edges, const PulseNoise& noise,
                                 std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  for (TrueEdge& edge : edges) {
    edge.t_s += edge_sigma_s(noise, edge.channel) * normal(rng);
  }
  return edges;
}

/// Returns the change of an edge's phase with coning, rad/rad; coning is a nutation with one cycle
/// per revolution.
/// @param azimuth_rad Azimuth of slit 1 at which the edge is expected.
Eigen::Vector2d phase_per_coning(const PredictedEdge& edge, double azimuth_rad) {
  return Eigen::Rotation2Dd{-azimuth_rad} * edge.phase_per_rotation.head<2>();
}

constexpr int kSteady = 5;
constexpr int kConing = 2;
constexpr int kUnknowns = kSteady + kConing + kModelErrors;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

Eigen::Matrix3d rotation(const Eigen::Vector3d& turned_rad) {
  return Eigen::AngleAxisd{turned_rad.norm(), turned_rad.stableNormalized()}.toRotationMatrix();
}

/// Holds a steady spin: frame, quadratic azimuth in it, and sensor errors.
struct Spin {
  Eigen::Matrix3d R_spin_icrf;
  Eigen::Vector3d azimuth;  ///< Azimuth at 0, rad; its rate, rad/s; half its acceleration, rad/s^2.
  Eigen::Vector2d coning_rad = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, kModelErrors, 1> errors_rad =
      Eigen::Matrix<double, kModelErrors, 1>::Zero();

  double azimuth_rad(double t_s) const {
    return azimuth[0] + (azimuth[1] + azimuth[2] * t_s) * t_s;
  }
  double rate_rad_s(double t_s) const { return azimuth[1] + 2.0 * azimuth[2] * t_s; }

  /// Returns the frame rotated by the full coning rotation, since that may reach a degree.
  /// @param slit_1_rad Expected azimuth of slit 1. The measured one would multiply noise by itself.
  Eigen::Matrix3d R_tipped_icrf(double slit_1_rad) const {
    const Eigen::Vector3d tip = Eigen::AngleAxisd{slit_1_rad, Eigen::Vector3d::UnitZ()} *
                                Eigen::Vector3d{coning_rad.x(), coning_rad.y(), 0.0};
    return rotation(-tip) * R_spin_icrf;
  }
};

/// Returns the true spin without nutation and coning.
Spin spin_of(const SpinMotion& motion) {
  Spin spin = {
      .R_spin_icrf = {},
      .azimuth = {motion.first_azimuth_rad, motion.rate_rad_s, 0.5 * motion.rate_drift_rad_s2}};
  spin.R_spin_icrf << tangent_basis(motion.axis_icrf).transpose(), motion.axis_icrf.transpose();
  return spin;
}

std::vector<UniformSpinResidual> against(const Spin& spin, const std::vector<TrueEdge>& edges,
                                         TaiTime start, const PulseNoise& noise) {
  const Orbit orbit = orbit_across_the_earth();
  const SpinConfig config = usual_config();
  std::vector<UniformSpinResidual> residuals;
  double sky_s = 0.0;
  Sky sky = sky_at(orbit, start);
  for (const auto& [t_s, channel] : edges) {
    if (t_s > sky_s + kSky_s) {
      sky_s = t_s;
      sky = sky_at(orbit, shifted(start, t_s));
    }
    const Pulse edge = {.t = shifted(start, t_s), .channel = channel};
    const double azimuth_rad = spin.azimuth_rad(t_s);
    const auto upright = predict_edge(config, sky, spin.R_spin_icrf, edge);
    if (!upright) {
      continue;
    }
    const double upright_rad = azimuth_rad - wrapped_rad(azimuth_rad - upright->phase_rad);
    const auto expected = predict_edge(config, sky, spin.R_tipped_icrf(upright_rad), edge);
    if (expected) {
      const double off_rad = wrapped_rad(azimuth_rad - expected->phase_rad -
                                         expected->phase_per_error * spin.errors_rad);
      residuals.push_back({.channel = channel,
                           .t_s = t_s,
                           .turns = (azimuth_rad - off_rad) / kTurn_rad,
                           .off_rad = off_rad,
                           .sigma_rad = edge_sigma_s(noise, channel) * spin.rate_rad_s(t_s),
                           .expected = *expected});
    }
  }
  return residuals;
}

struct Step {
  Unknowns change;  ///< Change of tilt, azimuth, coning and errors.
  Normal covariance;
};

/// @param known Prior information on each unknown, whose prior mean is zero.
Step step_of(const Spin& spin, const std::vector<UniformSpinResidual>& residuals,
             const Unknowns& known) {
  Normal normal = known.asDiagonal();
  Unknowns so_far = Unknowns::Zero();
  so_far.tail<kConing + kModelErrors>() << spin.coning_rad, spin.errors_rad;
  Unknowns right = -known.cwiseProduct(so_far);
  for (const UniformSpinResidual& residual : residuals) {
    const double t = residual.t_s / residuals.back().t_s;
    Unknowns row;
    row << residual.expected.phase_per_rotation.head<2>(), 1.0, t, t * t,
        phase_per_coning(residual.expected, kTurn_rad * residual.turns),
        residual.expected.phase_per_error.transpose();
    row /= residual.sigma_rad;
    normal += row * row.transpose();
    right += row * (residual.off_rad / residual.sigma_rad);
  }
  const auto solver = normal.ldlt();
  return {.change = solver.solve(right), .covariance = solver.solve(Normal::Identity())};
}

Spin changed(const Spin& spin, const Unknowns& change, double last_s) {
  return {.R_spin_icrf = rotation({-change[0], -change[1], 0.0}) * spin.R_spin_icrf,
          .azimuth = spin.azimuth -
                     Eigen::Vector3d{change[2], change[3] / last_s, change[4] / (last_s * last_s)},
          .coning_rad = spin.coning_rad + change.segment<kConing>(kSteady),
          .errors_rad = spin.errors_rad + change.tail<kModelErrors>()};
}

struct Fit {
  Spin spin;
  std::vector<UniformSpinResidual> residuals;
  Normal covariance;
};

Fit fitted(const Turning& turning, const PulseNoise& noise, const Unknowns& known,
           std::mt19937_64& rng) {
  const auto edges = with_noise(turning.edges, noise, rng);
  Fit fit = {.spin = spin_of(turning.truth.motion), .residuals = {}, .covariance = {}};
  fit.residuals = against(fit.spin, edges, turning.truth.start, noise);
  for (int i = 0; i < kSteps; ++i) {
    const Step step = step_of(fit.spin, fit.residuals, known);
    fit.spin = changed(fit.spin, step.change, fit.residuals.back().t_s);
    fit.residuals = against(fit.spin, edges, turning.truth.start, noise);
    fit.covariance = step.covariance;
  }
  return fit;
}

Unknowns known_beforehand(double coning_sigma_rad, double alignment_sigma_rad) {
  Unknowns known = Unknowns::Zero();
  known.segment<kConing>(kSteady).setConstant(std::pow(coning_sigma_rad, -2));
  known.tail<kModelErrors>().setConstant(std::pow(alignment_sigma_rad, -2));
  return known;
}

}  // namespace

SpinTruth steady_truth() {
  SpinTruth truth = truth_of(body_across_the_earth());
  truth.motion.first_azimuth_rad = 1.0;
  return truth;
}

Turning turning(const SpinTruth& truth, double duration_s) {
  const Orbit orbit = orbit_across_the_earth();
  return {.truth = truth, .edges = SpinEdges{truth, orbit}.until(duration_s).value()};
}

std::vector<UniformSpinResidual> uniform_spin_residuals(const Turning& turning,
                                                        const PulseNoise& noise,
                                                        std::mt19937_64& rng) {
  constexpr double kNone_rad = 1e-9;
  return fitted(turning, noise, known_beforehand(kNone_rad, kNone_rad), rng).residuals;
}

FittedConing fitted_coning(const Turning& turning, const PulseNoise& noise,
                           double alignment_sigma_rad, std::mt19937_64& rng) {
  constexpr double kAny_rad = 1.0;
  const Fit fit = fitted(turning, noise, known_beforehand(kAny_rad, alignment_sigma_rad), rng);
  return {.coning_rad = fit.spin.coning_rad,
          .covariance_rad2 = fit.covariance.block<kConing, kConing>(kSteady, kSteady)};
}

}  // namespace spindrift::testing
