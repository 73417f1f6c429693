#include "pipelines/spin/edge_prediction.h"

#include <Eigen/Geometry>
#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/horizon.h"
#include "pipelines/spin/measurement.h"

namespace spindrift {
namespace {

// So near (6 deg) to its limit, the axis or the end of slit 2, an edge is no measure of the axis.
constexpr double kLeastSlope = 0.1;

using PerError = Eigen::Matrix<double, 1, kModelErrors>;

std::optional<PredictedEdge> slit_edge(const Eigen::Vector3d& sun_spin, double separation_rad,
                                       double cant_rad) {
  const double across = std::hypot(sun_spin.x(), sun_spin.y());
  const double sin_lag = std::tan(cant_rad) * sun_spin.z() / across;
  if (!(across > kLeastSlope && std::abs(sin_lag) < 1.0)) {
    return std::nullopt;
  }
  const double middle_rad = std::atan2(sun_spin.y(), sun_spin.x()) + std::asin(sin_lag);
  // The Sun lies in the slit's plane: sun.normal = 0. Its derivatives as in horizon.h.
  const double cos_cant = std::cos(cant_rad);
  const Eigen::Vector3d normal{-cos_cant * std::sin(middle_rad), cos_cant * std::cos(middle_rad),
                               std::sin(cant_rad)};
  const Eigen::Vector3d slope = sun_spin.cross(normal);
  if (!(slope.z() > kLeastSlope * cos_cant * across)) {
    return std::nullopt;
  }
  const double cos_lag = std::sqrt(1.0 - sin_lag * sin_lag);
  return PredictedEdge{.phase_rad = wrapped_rad(middle_rad + separation_rad),
                       .phase_per_rotation = -slope / slope.z(),
                       .phase_per_error = PerError::Unit(SunAngleError) *
                                          (-std::tan(cant_rad) / (across * across * cos_lag))};
}

std::optional<PredictedEdge> beam_edge(const SpinConfig& config, Side side, const EarthView& earth,
                                       Crossing crossing) {
  const auto& sensor = sensor_of(config, side);
  if (!sensor) {
    return std::nullopt;
  }
  const auto limb =
      limb_crossing(horizon_axes(config.horizon), earth, sensor->mount_angle_rad, crossing);
  if (!limb) {
    return std::nullopt;
  }
  const bool north = side == Side::North;
  const ModelError limb_error = north ? NorthLimb : SouthLimb;
  const ModelError azimuth_error = north ? NorthAzimuth : SouthAzimuth;
  return PredictedEdge{.phase_rad = wrapped_rad(limb->azimuth_rad + sensor->azimuth_rad),
                       .phase_per_rotation = limb->azimuth_per_rotation,
                       .phase_per_error = limb->azimuth_per_limb * PerError::Unit(limb_error) +
                                          PerError::Unit(azimuth_error)};
}

}  // namespace

std::optional<PredictedEdge> predict_edge(const SpinConfig& config, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge) {
  const auto sun_spin = [&]() -> Eigen::Vector3d { return R_spin_icrf * sky.sun_icrf; };
  const auto earth = [&] {
    return EarthView{.spacecraft_spin_km = R_spin_icrf * spacecraft_icrf_km(sky, edge.t),
                     .pole_spin = R_spin_icrf * sky.earth_pole_icrf};
  };
  const SunSensor& sun = config.sun_sensor;
  switch (edge.channel) {
    case PulseChannel::Sun1:
      return slit_edge(sun_spin(), 0.0, 0.0);
    case PulseChannel::Sun2:
      return slit_edge(sun_spin(), sun.slit_separation_rad, sun.slit_cant_rad);
    case PulseChannel::NorthIn:
      return beam_edge(config, Side::North, earth(), Crossing::In);
    case PulseChannel::NorthOut:
      return beam_edge(config, Side::North, earth(), Crossing::Out);
    case PulseChannel::SouthIn:
      return beam_edge(config, Side::South, earth(), Crossing::In);
    case PulseChannel::SouthOut:
      return beam_edge(config, Side::South, earth(), Crossing::Out);
  }
  return std::nullopt;
}

double edge_sigma_s(const PulseNoise& noise, PulseChannel channel) {
  const bool sun = channel == PulseChannel::Sun1 || channel == PulseChannel::Sun2;
  return sun ? noise.sun_s : noise.infrared_s;
}

}  // namespace spindrift
