/// @file
/// Simulates when the sensors of a spinning spacecraft see the Sun and the edges of the Earth.
///
/// Each edge is the root of its own condition at its own time: the body turns, nutates and cones,
/// the spacecraft moves along its orbit, the Sun along the ecliptic. For the geometry of an
/// instant, seen from the axes that are tipped with the body (spin_motion.h), the condition gives
/// the azimuth that slit 1 must have,
///
///     sun1        the Sun's azimuth
///     sun2        the Sun's azimuth + psi0 + asin(cot theta_s tan I)
///     *_in, *_out azimuth at which the beam touches the horizon, its own azimuth added,
///
/// and the edge is where the body's azimuth meets it. Times are at the spacecraft: no light time
/// but that of the apparent Sun. Sun slits see no Sun that the Earth hides.

#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/ground_model/dynamics/body_spin.h"
#include "pipelines/ground_model/dynamics/spin_motion.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// True alignment of a pencil-beam infrared sensor and error of its electronics.
struct TrueInfrared {
  double mount_angle_rad;
  double azimuth_rad;
  double chord_excess_rad = 0.0;  ///< Excess of the measured chord, half of it at each end.
};

/// Ellipsoid of revolution about the pole; a sphere where both radii are equal.
struct EarthFigure {
  double equatorial_km;
  double polar_km;
  Eigen::Vector3d pole_icrf;  ///< Unit vector, ICRF.
};

/// Returns the infrared horizon: the sphere of the Earth's equatorial radius or the WGS-84
/// ellipsoid, its half axes lengthened by the CO2 altitude.
EarthFigure infrared_horizon(const Horizon& horizon, const Eigen::Vector3d& pole_icrf);

/// A turn about an inertially fixed axis and a tilt from it: SpinMotion or BodySpin.
template <class Motion>
concept SpunBody = requires(const Motion& motion, double t_s) {
  {Eigen::Vector3d{motion.axis_icrf}};
  { motion.azimuth_rad(t_s) } -> std::same_as<double>;
  { motion.rate_at_rad_s(t_s) } -> std::same_as<double>;
  { motion.R_axes_tipped(t_s) } -> std::same_as<Eigen::Matrix3d>;
  { motion.end_s() } -> std::same_as<double>;
};

/// The true spacecraft, sensors and horizon, as opposed to what the mission file says of them.
template <SpunBody Motion>
struct SpinTruthOf {
  TaiTime start;
  Motion motion;
  SunSensor sun_sensor;
  std::optional<TrueInfrared> north;
  std::optional<TrueInfrared> south;
  EarthFigure horizon;
};
using SpinTruth = SpinTruthOf<SpinMotion>;

struct TrueEdge {
  double t_s;  ///< Time since the start of the motion.
  PulseChannel channel;
};

/// Finds the edges of a pass, slice by slice. The times are accurate to 1e-10 s within a day. A
/// chord narrower than half a degree, or within half a degree of the whole turn, counts as unseen:
/// no beam is that fine, and steps would miss its edges.
template <SpunBody Motion>
class SpinEdges {
 public:
  /// @param orbit Must outlive this object.
  SpinEdges(const SpinTruthOf<Motion>& truth, const Orbit& orbit);

  /// Returns the edges from the end of the last slice (at first: the start) up to `end_s`,
  /// exclusive, in order of time and channel.
  /// @return NoCoverage where orbit or motion ends too early (the search looks a turn ahead of the
  ///         edges); Unobservable where the spacecraft dips below the horizon.
  Expected<std::vector<TrueEdge>> until(double end_s);

  /// Returns how often slit 1 has passed the Sun since the start, whether it saw the Sun or not.
  std::int64_t revolutions() const { return revolutions_; }

 private:
  /// Holds the geometry of an instant in the axes that are tipped with the body.
  struct View {
    Eigen::Vector3d sun_tipped;            ///< Unit vector to the Sun.
    Eigen::Vector3d earth_tipped_km;       ///< Vector from the spacecraft to the Earth's centre.
    Eigen::Matrix3d squeezed_from_tipped;  ///< Map to a space where the horizon is the unit sphere.
  };
  /// Azimuth of slit 1 at which a channel's edge happens. Without an edge it is a nearby azimuth,
  /// from which the search goes on to the next turn.
  struct Due {
    double azimuth_rad;
    bool seen;
  };
  struct Crossing {
    double t_s;
    bool seen;
  };
  struct Follower {
    PulseChannel channel;
    Crossing next;
  };

  Expected<View> view(double t_s);
  Due due(PulseChannel channel, const View& view) const;
  Due sun_due(PulseChannel channel, const View& view) const;
  static Due earth_due(const TrueInfrared& sensor, bool in, const View& view);
  static bool hides_sun(const View& view);
  Expected<Crossing> crossing_near(PulseChannel channel, double guess_s);
  Expected<Crossing> crossing_after(PulseChannel channel, double t_s);
  Expected<void> follow(Follower& follower, double end_s, std::vector<TrueEdge>& edges);
  Expected<void> start();

  SpinTruthOf<Motion> truth_;
  const Orbit* orbit_;
  ApparentSun sun_;
  Eigen::Matrix3d axes_from_icrf_;
  Eigen::Matrix3d squeezed_from_axes_;
  std::vector<Follower> followers_;
  std::int64_t revolutions_ = 0;
};

extern template class SpinEdges<BodySpin>;
extern template class SpinEdges<SpinMotion>;

}  // namespace spindrift
