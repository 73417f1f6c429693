#include "tests/support/information_limit.h"

#include <Eigen/LU>
#include <cmath>

#include "pipelines/frames/celestial.h"

namespace spindrift::testing {

namespace {

/// Returns the body after a step of one component: axis (east, north), phase, or rate. The step is
/// in rad; for the rate it is the angle gained over the whole pass.
SpinningBody moved(SpinningBody body, Eigen::Index component, double step, double duration_s) {
  if (component < 2) {
    // The turn also rotates the oracle's body frame a little about the axis, which the unknown
    // phase absorbs.
    const Eigen::Vector3d across = tangent_basis(body.axis_icrf).col(component);
    body.axis_icrf = (body.axis_icrf + step * across).normalized();
  } else if (component == 2) {
    body.first_turn_rad += step;
  } else {
    body.rate_rad_s += step / duration_s;
  }
  return body;
}

}  // namespace

Eigen::Matrix2d cramer_rao_rad2(const SpinningBody& body, const SunEarthEphemeris& around,
                                double duration_s) {
  constexpr double kStep = 1e-4;  // Step, rad; for the rate, the angle gained over the pass.
  const auto truth = edges_between(body, around, 0.0, duration_s);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(truth.size()), 4);
  for (Eigen::Index component = 0; component < 4; ++component) {
    for (const double step : {kStep, -kStep}) {
      const auto edges =
          edges_between(moved(body, component, step, duration_s), around, 0.0, duration_s);
      for (std::size_t i = 0; i < truth.size(); ++i) {
        // An edge at either end of the pass may have appeared or vanished and then has no partner.
        for (const Edge& edge : edges) {
          if (edge.channel == truth[i].channel && std::abs(edge.t_s - truth[i].t_s) < 0.05) {
            const double sigma_s =
                edge.channel == PulseChannel::Sun1 || edge.channel == PulseChannel::Sun2
                    ? body.config.noise.sun_s
                    : body.config.noise.infrared_s;
            slopes(static_cast<Eigen::Index>(i), component) +=
                (edge.t_s - truth[i].t_s) / step / 2.0 / sigma_s;
          }
        }
      }
    }
  }
  const Eigen::Matrix4d information = slopes.transpose() * slopes;
  return information.inverse().topLeftCorner<2, 2>();
}

}  // namespace spindrift::testing
