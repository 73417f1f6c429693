#include "pipelines/spin/sensor_model/edge_prediction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/types/side.h"

namespace spindrift {
namespace {

using PerBias = Eigen::Matrix<double, 1, kSensorBiases>;
using PerError = Eigen::Matrix<double, 1, kModelErrors>;
using PerAlignment = Eigen::Matrix<double, 1, kSpinAlignmentErrors>;
using Slope = Eigen::Matrix<double, 5, 1>;

/// Holds the Sun's azimuth, which is that of a slit in a meridian when it sees the Sun.
struct SunView {
  double azimuth_rad;
  double angle_rad;  ///< Angle theta_s from the axis.
  Eigen::Vector3d azimuth_per_rotation;
  Eigen::Vector3d angle_per_rotation;
};

std::optional<SunView> view_of_sun(const Eigen::Vector3d& sun_spin) {
  const double across = std::hypot(sun_spin.x(), sun_spin.y());
  // The Sun within this sine of the axis (0.6 deg) has no azimuth.
  if (!(across > 0.01)) {
    return std::nullopt;
  }
  const Eigen::Vector3d towards{sun_spin.x() / across, sun_spin.y() / across, 0.0};
  const double cotangent = sun_spin.z() / across;
  return SunView{.azimuth_rad = std::atan2(sun_spin.y(), sun_spin.x()),
                 .angle_rad = std::atan2(across, sun_spin.z()),
                 .azimuth_per_rotation = {cotangent * towards.x(), cotangent * towards.y(), -1.0},
                 .angle_per_rotation = {towards.y(), -towards.x(), 0.0}};
}

/// Holds the phase at which a slit sees the Sun.
struct SlitView {
  double phase_rad;
  Eigen::Vector3d phase_per_rotation;
  double phase_per_sun_angle;
  double phase_per_cant;
};

std::optional<SlitView> view_of_slit(const SunSensor& slit, const Eigen::Vector3d& sun_spin,
                                     double sun_angle_bias_rad) {
  const auto sun = view_of_sun(sun_spin);
  if (!sun) {
    return std::nullopt;
  }
  const double measured_rad = sun->angle_rad + sun_angle_bias_rad;
  const double tan_cant = std::tan(slit.slit_cant_rad);
  const double sin_lag = tan_cant / std::tan(measured_rad);
  const double cos_lag = std::sqrt(1.0 - sin_lag * sin_lag);
  // The negated comparison also rejects the NaN of sin_lag beyond 1, where the slit ends.
  // Within this cosine (6 deg) of the end of slit 2 an edge does not measure the axis.
  if (!(cos_lag > 0.1)) {
    return std::nullopt;
  }
  const double sine = std::sin(measured_rad);
  const double by_sun_angle = -tan_cant / (sine * sine * cos_lag);
  return SlitView{
      .phase_rad = sun->azimuth_rad + std::asin(sin_lag) + slit.slit_separation_rad,
      .phase_per_rotation = sun->azimuth_per_rotation + by_sun_angle * sun->angle_per_rotation,
      .phase_per_sun_angle = by_sun_angle,
      .phase_per_cant = (1.0 + tan_cant * tan_cant) / (std::tan(measured_rad) * cos_lag)};
}

Eigen::Vector2d coning_of(const SensorBiases& biases) { return {biases[ConingX], biases[ConingY]}; }

PerBias per_coning(const Eigen::RowVector2d& slopes) {
  return slopes.x() * PerBias::Unit(ConingX) + slopes.y() * PerBias::Unit(ConingY);
}

PerBias per_coning(const SlitView& view, const ConedSlit& as_coned) {
  return per_coning(view.phase_per_cant * as_coned.cant_per_coning +
                    as_coned.separation_per_coning);
}

std::optional<PredictedEdge> sun1_edge(const ConedSlit& slit, const Eigen::Vector3d& sun_spin) {
  const auto view = view_of_slit(slit.slit, sun_spin, 0.0);
  if (!view) {
    return std::nullopt;
  }
  return PredictedEdge{.phase_rad = wrapped_rad(view->phase_rad),
                       .phase_per_rotation = view->phase_per_rotation,
                       .phase_per_error = PerError::Zero(),
                       .phase_per_bias = per_coning(*view, slit),
                       .phase_per_alignment = PerAlignment::Zero()};
}

std::optional<PredictedEdge> sun2_edge(const ConedSlit& slit, const Eigen::Vector3d& sun_spin,
                                       const SensorBiases& biases) {
  const auto view = view_of_slit(slit.slit, sun_spin, biases[SunAngleBias]);
  if (!view) {
    return std::nullopt;
  }
  return PredictedEdge{
      .phase_rad = wrapped_rad(view->phase_rad + biases[SlitSeparationBias]),
      .phase_per_rotation = view->phase_per_rotation,
      .phase_per_error = view->phase_per_sun_angle * PerError::Unit(SunAngleError),
      .phase_per_bias = view->phase_per_sun_angle * PerBias::Unit(SunAngleBias) +
                        PerBias::Unit(SlitSeparationBias) + per_coning(*view, slit),
      .phase_per_alignment = view->phase_per_cant * PerAlignment::Unit(SlitCantError) +
                             PerAlignment::Unit(SlitSeparationError)};
}

struct Beam {
  Side side;
  Crossing crossing;
};

/// Returns beam and crossing of a channel that is no slit.
Beam beam_of(PulseChannel channel) {
  const bool north = channel == PulseChannel::NorthIn || channel == PulseChannel::NorthOut;
  const bool in = channel == PulseChannel::NorthIn || channel == PulseChannel::SouthIn;
  return {.side = north ? Side::North : Side::South, .crossing = in ? Crossing::In : Crossing::Out};
}

/// Returns the change of a crossing's azimuth per second that its time tag is late.
double per_late_tag(const LimbCrossing& limb, const Sky& sky, const Eigen::Matrix3d& R_spin_icrf) {
  return -limb.azimuth_per_position_km.dot(R_spin_icrf * sky.spacecraft.velocity_icrf_km_s);
}

EarthView earth_view(const Sky& sky, const Eigen::Matrix3d& R_spin_icrf, TaiTime t) {
  return {.spacecraft_spin_km = R_spin_icrf * spacecraft_icrf_km(sky, t),
          .pole_spin = R_spin_icrf * sky.earth_pole_icrf};
}

struct BeamBiases {
  SensorBias mount_angle;
  SensorBias chord;
};

BeamBiases biases_of(Side side) {
  return side == Side::North ? BeamBiases{NorthMountAngleBias, NorthChordBias}
                             : BeamBiases{SouthMountAngleBias, SouthChordBias};
}

std::optional<PredictedEdge> beam_edge(const PlacedSensors& sensors, Beam beam, const Sky& sky,
                                       const Eigen::Matrix3d& R_spin_icrf, TaiTime t) {
  const auto [side, crossing] = beam;
  const std::optional<ConedBeam>& placed = sensors.beams.at(index_of(side));
  if (!placed) {
    return std::nullopt;
  }
  const auto& [sensor, mount_angle_per_coning, azimuth_per_coning] = *placed;
  const SensorBiases& biases = sensors.biases;
  const auto [mount_angle, chord] = biases_of(side);
  const auto limb = limb_crossing(sensors.horizon, earth_view(sky, R_spin_icrf, t),
                                  sensor.mount_angle_rad + biases[mount_angle], crossing);
  if (!limb) {
    return std::nullopt;
  }
  const bool north = side == Side::North;
  const ModelError limb_error = north ? NorthLimb : SouthLimb;
  const ModelError azimuth_error = north ? NorthAzimuth : SouthAzimuth;
  const double half_chord = crossing == Crossing::In ? -0.5 : 0.5;
  return PredictedEdge{
      .phase_rad = wrapped_rad(limb->azimuth_rad + sensor.azimuth_rad + biases[DihedralBias] +
                               half_chord * biases[chord]),
      .phase_per_rotation = limb->azimuth_per_rotation,
      .phase_per_error =
          limb->azimuth_per_limb * PerError::Unit(limb_error) + PerError::Unit(azimuth_error),
      .phase_per_bias =
          limb->azimuth_per_mount * PerBias::Unit(mount_angle) + half_chord * PerBias::Unit(chord) +
          PerBias::Unit(DihedralBias) + limb->azimuth_per_height_km * PerBias::Unit(Co2HeightBias) +
          per_coning(limb->azimuth_per_mount * mount_angle_per_coning + azimuth_per_coning),
      .phase_per_alignment =
          limb->azimuth_per_mount *
              PerAlignment::Unit(north ? NorthMountAngleError : SouthMountAngleError) +
          PerAlignment::Unit(north ? NorthAzimuthError : SouthAzimuthError) +
          limb->azimuth_per_height_km * PerAlignment::Unit(Co2AltitudeError) +
          per_late_tag(*limb, sky, R_spin_icrf) * PerAlignment::Unit(TimeTagError)};
}

std::optional<ConedBeam> placed_beam(const std::optional<InfraredSensor>& beam,
                                     const SensorBiases& biases) {
  return beam ? std::optional{as_coned(*beam, coning_of(biases))} : std::nullopt;
}

HorizonAxes biased_horizon(Horizon horizon, const SensorBiases& biases) {
  horizon.co2_altitude_km += biases[Co2HeightBias];
  return horizon_axes(horizon);
}

/// Scales the matrix to a unit diagonal, since dt^2 and a tilt differ by ten orders.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& normal) {
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    unit[i] = normal(i, i) > 0.0 ? 1.0 / std::sqrt(normal(i, i)) : 0.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scaled{unit.asDiagonal() * normal *
                                                              unit.asDiagonal()};
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    // Relative eigenvalue below which phase, rate and drift are not separated, as with edges of one
    // time.
    if (scaled.eigenvalues()[i] > 1e-12) {
      inverse[i] = 1.0 / scaled.eigenvalues()[i];
    }
  }
  return unit.asDiagonal() * scaled.eigenvectors() * inverse.asDiagonal() *
         scaled.eigenvectors().transpose() * unit.asDiagonal();
}

}  // namespace

PlacedSensors::PlacedSensors(const SpinConfig& config, SensorBiases sensor_biases)
    : biases{std::move(sensor_biases)},
      sun1{
          as_coned(SunSensor{.slit_cant_rad = 0.0, .slit_separation_rad = 0.0}, coning_of(biases))},
      sun2{as_coned(config.sun_sensor, coning_of(biases))},
      beams{placed_beam(config.north, biases), placed_beam(config.south, biases)},
      horizon{biased_horizon(config.horizon, biases)} {}

std::optional<PredictedEdge> predict_edge(const PlacedSensors& sensors, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge) {
  const Eigen::Vector3d sun_spin = R_spin_icrf * sky.sun_icrf;
  if (edge.channel == PulseChannel::Sun1) {
    return sun1_edge(sensors.sun1, sun_spin);
  }
  if (edge.channel == PulseChannel::Sun2) {
    return sun2_edge(sensors.sun2, sun_spin, sensors.biases);
  }
  return beam_edge(sensors, beam_of(edge.channel), sky, R_spin_icrf, edge.t);
}

std::optional<PredictedEdge> predict_edge(const SpinConfig& config, const Sky& sky,
                                          const Eigen::Matrix3d& R_spin_icrf, const Pulse& edge) {
  return predict_edge(PlacedSensors{config, SensorBiases::Zero()}, sky, R_spin_icrf, edge);
}

std::optional<PredictedEdge> linearise_by_depth(const SpinConfig& config, const Sky& sky,
                                                const Eigen::Matrix3d& R_spin_icrf,
                                                const Pulse& edge, double phase_rad,
                                                double sigma_rad) {
  if (sees_the_sun(edge.channel)) {
    return std::nullopt;
  }
  const auto [side, crossing] = beam_of(edge.channel);
  if (!sensor_of(config, side)) {
    return std::nullopt;
  }
  const InfraredSensor& sensor = *sensor_of(config, side);
  const auto limb =
      limb_distance(horizon_axes(config.horizon), earth_view(sky, R_spin_icrf, edge.t),
                    sensor.mount_angle_rad, phase_rad - sensor.azimuth_rad);
  if (!limb) {
    return std::nullopt;
  }
  // Half a chord counts as at least this many times the noise of its edges.
  const double slope = std::max(std::abs(limb->depth_per_rotation.z()),
                                2.0 * sigma_rad * std::abs(limb->depth_bend));
  const double scale = crossing == Crossing::In ? slope : -slope;
  return PredictedEdge{.phase_rad = wrapped_rad(phase_rad - limb->depth / scale),
                       .phase_per_rotation = -limb->depth_per_rotation / scale,
                       .phase_per_error = PerError::Zero(),
                       .phase_per_bias = PerBias::Zero(),
                       .phase_per_alignment = PerAlignment::Zero()};
}

void EdgeInformation::add(const PredictedEdge& edge, double dt_s, double sigma_rad, double weight) {
  const Slope slope{edge.phase_per_rotation.x(), edge.phase_per_rotation.y(), -1.0, -dt_s,
                    -0.5 * dt_s * dt_s};
  normal_ += weight / (sigma_rad * sigma_rad) * slope * slope.transpose();
}

std::optional<Eigen::Matrix2d> EdgeInformation::axis_covariance_rad2() const {
  const Eigen::Matrix<double, 2, 3> shared = normal_.topRightCorner<2, 3>();
  const Eigen::Matrix2d information =
      normal_.topLeftCorner<2, 2>() -
      shared * pseudo_inverse(normal_.bottomRightCorner<3, 3>()) * shared.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> directions;
  directions.computeDirect(information, Eigen::EigenvaluesOnly);
  if (!(directions.eigenvalues().minCoeff() >
        1.0 / (kLeastDetermined_rad * kLeastDetermined_rad))) {
    return std::nullopt;
  }
  // A tilt about the first axis moves the spin axis against the second.
  Eigen::Matrix2d axis_from_tilts;
  axis_from_tilts << 0.0, 1.0, -1.0, 0.0;
  return axis_from_tilts * information.inverse() * axis_from_tilts.transpose();
}

}  // namespace spindrift
