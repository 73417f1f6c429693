#include "tests/support/spinning_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift::testing {
namespace {

constexpr double kEquatorialRadius_km = 6378.137;
constexpr double kPolarRadius_km = 6356.752314245;
constexpr double kStepsPerTurn = 720.0;
constexpr int kHalvings = 45;

using Signal = std::function<double(double t_s)>;

Eigen::Matrix3d rotation_icrf_body(const SpinningBody& body, double t_s) {
  const Eigen::Quaterniond to_axis = frame_about(body.axis_icrf);
  const double turn_rad = body.first_turn_rad + body.rate_rad_s * t_s;
  return (to_axis * Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitZ()}).toRotationMatrix();
}

/// Returns the direction on the body's equator at this azimuth behind slit 1.
Eigen::Vector3d equator_body(double behind_rad) {
  return Eigen::AngleAxisd{-behind_rad, Eigen::Vector3d::UnitZ()} * Eigen::Vector3d::UnitX();
}

/// Holds the half-plane of a slit: the plane's normal, and a vector on the side that sees.
struct Slit {
  Eigen::Vector3d middle_body;
  Eigen::Vector3d normal_body;
};

/// Returns a meridian slit tipped about its point on the equator, north end further behind.
Slit slit_at(double behind_rad, double cant_rad) {
  const Eigen::Vector3d middle = equator_body(behind_rad);
  const Eigen::Vector3d north = Eigen::AngleAxisd{cant_rad, middle} * Eigen::Vector3d::UnitZ();
  return {.middle_body = middle, .normal_body = middle.cross(north)};
}

Eigen::Vector3d beam_body(const InfraredSensor& sensor) {
  const Eigen::Vector3d equator = equator_body(sensor.azimuth_rad);
  const Eigen::Vector3d sideways = Eigen::Vector3d::UnitZ().cross(equator);
  return Eigen::AngleAxisd{sensor.mount_angle_rad, sideways} * Eigen::Vector3d::UnitZ();
}

/// Returns a value that is positive where the ray meets the horizon. It is computed from the
/// distance of the ray to the Earth's centre in a space scaled so that the horizon is the unit
/// sphere.
double immersion(const Eigen::Vector3d& ray, const Eigen::Vector3d& centre_km,
                 const Eigen::Vector3d& horizon_km) {
  const Eigen::Vector3d along = ray.cwiseQuotient(horizon_km).normalized();
  const Eigen::Vector3d centre = centre_km.cwiseQuotient(horizon_km);
  return along.dot(centre) > 0.0 ? 1.0 - centre.cross(along).squaredNorm() : -1.0;
}

double zero_between(const Signal& signal, double before_s, double after_s) {
  const bool rising = signal(before_s) < 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_s = 0.5 * (before_s + after_s);
    ((signal(middle_s) < 0.0) == rising ? before_s : after_s) = middle_s;
  }
  return 0.5 * (before_s + after_s);
}

/// Calls `found(t_s, rising)` for every change of sign of the signal.
void scan(const Signal& signal, double from_s, double to_s, double step_s,
          const std::function<void(double t_s, bool rising)>& found) {
  bool negative = signal(from_s) < 0.0;
  const auto steps = static_cast<int>(std::ceil((to_s - from_s) / step_s));
  for (int i = 1; i <= steps; ++i) {
    const double t_s = std::min(from_s + i * step_s, to_s);
    const bool negative_now = signal(t_s) < 0.0;
    if (negative_now != negative) {
      found(zero_between(signal, from_s + (i - 1) * step_s, t_s), negative);
      negative = negative_now;
    }
  }
}

std::optional<double> first_after(const std::vector<Edge>& edges, PulseChannel channel,
                                  double t_s) {
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const Edge& edge) {
    return edge.channel == channel && edge.t_s >= t_s;
  });
  return found == edges.end() ? std::nullopt : std::optional{found->t_s};
}

}  // namespace

Eigen::Vector3d spherical_horizon_km(double h_km) {
  return Eigen::Vector3d::Constant(kEquatorialRadius_km + h_km);
}

Eigen::Vector3d ellipsoidal_horizon_km(double h_km) {
  return {kEquatorialRadius_km + h_km, kEquatorialRadius_km + h_km, kPolarRadius_km + h_km};
}

Eigen::Vector3d usual_horizon_km(HorizonModel model) {
  return model == HorizonModel::Sphere ? spherical_horizon_km(40.0) : ellipsoidal_horizon_km(40.0);
}

Eigen::Vector3d random_direction(std::normal_distribution<double>& normal, std::mt19937_64& rng) {
  const double x = normal(rng);
  const double y = normal(rng);
  return Eigen::Vector3d{x, y, normal(rng)}.normalized();
}

SunEarthEphemeris at_rest(const Eigen::Vector3d& sun_icrf, const Eigen::Vector3d& earth_icrf_km) {
  return {.sun_icrf = [sun_icrf](double) { return sun_icrf; },
          .earth_icrf_km = [earth_icrf_km](double) { return earth_icrf_km; },
          .horizon_km = spherical_horizon_km(40.0)};
}

Eigen::Matrix3d spin_frame(const Eigen::Vector3d& axis_icrf) {
  return frame_about(axis_icrf).conjugate().toRotationMatrix();
}

SpinConfig usual_config() {
  return {
      .sun_sensor = {.slit_cant_rad = 45.0 * kRadPerDeg, .slit_separation_rad = 35.0 * kRadPerDeg},
      .north =
          InfraredSensor{.mount_angle_rad = 85.0 * kRadPerDeg, .azimuth_rad = 90.0 * kRadPerDeg},
      .south =
          InfraredSensor{.mount_angle_rad = 95.0 * kRadPerDeg, .azimuth_rad = 92.0 * kRadPerDeg},
      .noise = {.sun_s = 1e-4, .infrared_s = 5e-4},
      .horizon = {.model = HorizonModel::Sphere, .co2_altitude_km = 40.0},
      .screening = {},
      .geometry = {},
      .prior = {}};
}

std::vector<Edge> edges_between(const SpinningBody& body, const SunEarthEphemeris& around,
                                double from_s, double to_s) {
  const double step_s = kTurn_rad / (body.rate_rad_s * kStepsPerTurn);
  std::vector<Edge> edges;

  const auto watch_sun = [&](const Slit& slit, PulseChannel channel) {
    const auto sun_body = [&](double t_s) -> Eigen::Vector3d {
      return rotation_icrf_body(body, t_s).transpose() * around.sun_icrf(t_s);
    };
    scan([&](double t_s) { return slit.normal_body.dot(sun_body(t_s)); }, from_s, to_s, step_s,
         [&](double t_s, bool) {
           if (slit.middle_body.dot(sun_body(t_s)) > 0.0) {
             edges.push_back({.t_s = t_s, .channel = channel});
           }
         });
  };
  const auto watch_earth = [&](const InfraredSensor& sensor, PulseChannel in, PulseChannel out) {
    const Eigen::Vector3d ray_body = beam_body(sensor);
    scan(
        [&](double t_s) {
          return immersion(rotation_icrf_body(body, t_s) * ray_body, around.earth_icrf_km(t_s),
                           around.horizon_km);
        },
        from_s, to_s, step_s,
        [&](double t_s, bool rising) {
          edges.push_back({.t_s = t_s, .channel = rising ? in : out});
        });
  };

  const SunSensor& sun_sensor = body.config.sun_sensor;
  watch_sun(slit_at(0.0, 0.0), PulseChannel::Sun1);
  watch_sun(slit_at(sun_sensor.slit_separation_rad, sun_sensor.slit_cant_rad), PulseChannel::Sun2);
  if (body.config.north) {
    watch_earth(*body.config.north, PulseChannel::NorthIn, PulseChannel::NorthOut);
  }
  if (body.config.south) {
    watch_earth(*body.config.south, PulseChannel::SouthIn, PulseChannel::SouthOut);
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.t_s < b.t_s; });
  return edges;
}

std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start) {
  std::vector<Pulse> pulses(edges.size());
  std::transform(edges.begin(), edges.end(), pulses.begin(), [&](const Edge& edge) {
    return Pulse{.t = shifted(start, edge.t_s), .channel = edge.channel};
  });
  return pulses;
}

std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start,
                               const PulseNoise& noise, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<Pulse> pulses = pulses_from(edges, start);
  for (Pulse& pulse : pulses) {
    const bool sun = pulse.channel == PulseChannel::Sun1 || pulse.channel == PulseChannel::Sun2;
    pulse.t = shifted(pulse.t, (sun ? noise.sun_s : noise.infrared_s) * normal(rng));
  }
  std::sort(pulses.begin(), pulses.end());
  return pulses;
}

Revolution revolution_seen(const SpinningBody& body, const SunEarthEphemeris& around,
                           TaiTime start) {
  using enum PulseChannel;
  const double period_s = kTurn_rad / body.rate_rad_s;
  const std::vector<Edge> edges = edges_between(body, around, 0.0, 4.0 * period_s);
  Revolution seen{.number = 0,
                  .edges = {},
                  .period_candidate = {},
                  .period = {.period_s = period_s, .sigma_s = 0.0}};
  const auto keep = [&](PulseChannel channel, const std::optional<double>& t_s) {
    if (t_s) {
      seen.edges.at(index_of(channel)) = shifted(start, *t_s);
    }
  };
  // The second sun1 is used so that all edges that belong to it lie in the scanned interval.
  const auto sun1_s = first_after(edges, Sun1, period_s);
  if (!sun1_s) {
    return seen;
  }
  keep(Sun1, sun1_s);
  const double sun2_s = *sun1_s + body.config.sun_sensor.slit_separation_rad / body.rate_rad_s;
  keep(Sun2, first_after(edges, Sun2, sun2_s - 0.5 * period_s));
  for (const auto& [in, out] : {std::pair{NorthIn, NorthOut}, std::pair{SouthIn, SouthOut}}) {
    const auto in_s = first_after(edges, in, *sun1_s);
    keep(in, in_s);
    if (in_s) {
      keep(out, first_after(edges, out, *in_s));
    }
  }
  return seen;
}

}  // namespace spindrift::testing
