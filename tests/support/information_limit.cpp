#include "tests/support/information_limit.h"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "pipelines/frames/celestial.h"

namespace spindrift::testing {

namespace {

/// By a step of the axis (east, north), of the phase, or of the rate: rad, over the whole pass.
SpinningBody moved(SpinningBody body, Eigen::Index component, double step, double duration_s) {
  if (component < 2) {
    // Turned about an axis across: the oracle's own frame then turns with it a little about the
    // axis, which the unknown phase takes up.
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
  constexpr double kStep = 1e-4;  // rad; of the rate, rad over the whole pass.
  const auto truth = edges_between(body, around, 0.0, duration_s);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(truth.size()), 4);
  for (Eigen::Index component = 0; component < 4; ++component) {
    for (const double step : {kStep, -kStep}) {
      const auto edges =
          edges_between(moved(body, component, step, duration_s), around, 0.0, duration_s);
      for (std::size_t i = 0; i < truth.size(); ++i) {
        // An edge at either end of the pass may have come or gone: then it has no partner here.
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
