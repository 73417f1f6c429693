#include "pipelines/ground_model/sensors/spin_edges.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/wgs84.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr double kNarrowestHalf_rad = 0.25 * kRadPerDeg;

// A step this small changes no nanosecond. The root after the last secant step is a hundred times
// more accurate than that step is long.
constexpr double kConverged_s = 1e-10;
constexpr double kSlopeFrom_s = 1e-6;  // Slopes between closer points are mere rounding.
constexpr double kLeastTurn_rad = 0.25 * kTurn_rad;  // Least turn between two edges of a channel.
constexpr int kMostSteps = 30;
constexpr double kConverged_rad = 1e-13;
constexpr int kMostHalvings = 60;

double azimuth_of(const Eigen::Vector3d& direction) {
  return std::atan2(direction.y(), direction.x());
}

/// Returns how deep a ray of any length from the spacecraft dips below the horizon, in a space
/// where the horizon is the unit sphere about `centre`. Negative: it misses; 0: it is tangent.
double depth(const Eigen::Vector3d& ray, const Eigen::Vector3d& centre) {
  return centre.dot(ray) - std::sqrt(centre.squaredNorm() - 1.0) * ray.norm();
}

/// Gives the depth of a beam that turns about the axis as a function of its azimuth.
class BeamDepth {
 public:
  /// @param squeezed_from_tipped Map to the space of `depth`, where the Earth is at `centre`.
  BeamDepth(double mount_angle_rad, const Eigen::Matrix3d& squeezed_from_tipped,
            Eigen::Vector3d centre)
      : east_{std::sin(mount_angle_rad) * squeezed_from_tipped.col(0)},
        north_{std::sin(mount_angle_rad) * squeezed_from_tipped.col(1)},
        along_{std::cos(mount_angle_rad) * squeezed_from_tipped.col(2)},
        centre_{std::move(centre)},
        tangent_{std::sqrt(centre_.squaredNorm() - 1.0)} {}

  struct Value {
    double depth;
    double slope;
    double curvature;
  };
  Value at(double azimuth_rad) const {
    const double sine = std::sin(azimuth_rad);
    const double cosine = std::cos(azimuth_rad);
    const Eigen::Vector3d turning = cosine * east_ + sine * north_;
    const Eigen::Vector3d ray = turning + along_;
    const Eigen::Vector3d slope = cosine * north_ - sine * east_;
    const double length = ray.norm();
    const double length_slope = ray.dot(slope) / length;
    const double length_curvature =
        (slope.squaredNorm() - ray.dot(turning) - length_slope * length_slope) / length;
    return {.depth = centre_.dot(ray) - tangent_ * length,
            .slope = centre_.dot(slope) - tangent_ * length_slope,
            .curvature = -centre_.dot(turning) - tangent_ * length_curvature};
  }

  /// Returns the azimuth near `guess_rad` where the beam is deepest; empty where there is no
  /// maximum, as with the Earth along the axis.
  std::optional<double> deepest_near(double guess_rad) const {
    double azimuth_rad = guess_rad;
    for (int i = 0; i < kMostSteps; ++i) {
      const Value here = at(azimuth_rad);
      if (!(here.curvature < 0.0)) {
        return std::nullopt;
      }
      const double step_rad = -here.slope / here.curvature;
      azimuth_rad += step_rad;
      if (std::abs(step_rad) < kConverged_rad) {
        return azimuth_rad;
      }
    }
    return std::nullopt;
  }

  /// Returns the azimuth of zero depth between one inside the horizon and one outside, by Newton
  /// steps that are replaced by bisection where they leave the interval.
  double limb_between(double inside_rad, double outside_rad) const {
    double azimuth_rad = 0.5 * (inside_rad + outside_rad);
    for (int i = 0; i < kMostHalvings; ++i) {
      const Value here = at(azimuth_rad);
      (here.depth > 0.0 ? inside_rad : outside_rad) = azimuth_rad;
      double next_rad = azimuth_rad - here.depth / here.slope;
      const auto [low_rad, high_rad] = std::minmax(inside_rad, outside_rad);
      // Written so that an infinite step or NaN fails.
      if (!(next_rad > low_rad && next_rad < high_rad)) {
        next_rad = 0.5 * (inside_rad + outside_rad);
      }
      if (std::abs(std::exchange(azimuth_rad, next_rad) - next_rad) < kConverged_rad) {
        break;
      }
    }
    return azimuth_rad;
  }

 private:
  Eigen::Vector3d east_;
  Eigen::Vector3d north_;
  Eigen::Vector3d along_;
  Eigen::Vector3d centre_;
  double tangent_;
};

}  // namespace

EarthFigure infrared_horizon(const Horizon& horizon, const Eigen::Vector3d& pole_icrf) {
  const bool sphere = horizon.model == HorizonModel::Sphere;
  return {.equatorial_km = wgs84::kEquatorialRadius_km + horizon.co2_altitude_km,
          .polar_km = (sphere ? wgs84::kEquatorialRadius_km : wgs84::kPolarRadius_km) +
                      horizon.co2_altitude_km,
          .pole_icrf = pole_icrf};
}

template <SpunBody Motion>
SpinEdges<Motion>::SpinEdges(const SpinTruthOf<Motion>& truth, const Orbit& orbit)
    : truth_{truth}, orbit_{&orbit} {
  axes_from_icrf_.topRows<2>() = tangent_basis(truth.motion.axis_icrf).transpose();
  axes_from_icrf_.row(2) = truth.motion.axis_icrf.transpose();
  const Eigen::Vector3d pole = axes_from_icrf_ * truth.horizon.pole_icrf;
  const double equatorial_per_km = 1.0 / truth.horizon.equatorial_km;
  const double polar_per_km = 1.0 / truth.horizon.polar_km;
  squeezed_from_axes_ = equatorial_per_km * Eigen::Matrix3d::Identity() +
                        (polar_per_km - equatorial_per_km) * pole * pole.transpose();
}

template <SpunBody Motion>
auto SpinEdges<Motion>::view(double t_s) -> Expected<View> {
  const TaiTime t = shifted(truth_.start, t_s);
  if (t_s > truth_.motion.end_s()) {
    return Unexpected{
        {ErrorCode::NoCoverage,
         fmt::format("the motion of the body ends {} s behind its start: {} is asked for",
                     truth_.motion.end_s(), format_utc(t))}};
  }
  return orbit_->at(t).and_then([&](const OrbitState& state) -> Expected<View> {
    const double range_km = state.position_icrf_km.norm();
    if (!(range_km > truth_.horizon.equatorial_km)) {
      return Unexpected{
          {ErrorCode::Unobservable,
           fmt::format("the spacecraft is {:.3f} km from the Earth's centre at {}: must be above "
                       "the infrared horizon, {} km",
                       range_km, format_utc(t), truth_.horizon.equatorial_km)}};
    }
    const Eigen::Matrix3d R_axes_tipped = truth_.motion.R_axes_tipped(t_s);
    const Eigen::Vector3d sun_axes = axes_from_icrf_ * sun_.direction_icrf(t, state);
    const Eigen::Vector3d earth_axes_km = -(axes_from_icrf_ * state.position_icrf_km);
    return View{.sun_tipped = R_axes_tipped.transpose() * sun_axes,
                .earth_tipped_km = R_axes_tipped.transpose() * earth_axes_km,
                .squeezed_from_tipped = squeezed_from_axes_ * R_axes_tipped};
  });
}

template <SpunBody Motion>
bool SpinEdges<Motion>::hides_sun(const View& view) {
  return depth(view.squeezed_from_tipped * view.sun_tipped,
               view.squeezed_from_tipped * view.earth_tipped_km) > 0.0;
}

template <SpunBody Motion>
auto SpinEdges<Motion>::sun_due(PulseChannel channel, const View& view) const -> Due {
  const Eigen::Vector3d& sun = view.sun_tipped;
  const bool lit = !hides_sun(view);
  if (channel == PulseChannel::Sun1) {
    return {.azimuth_rad = azimuth_of(sun), .seen = lit};
  }
  const double middle_rad = azimuth_of(sun) + truth_.sun_sensor.slit_separation_rad;
  const double sine =
      sun.z() / std::hypot(sun.x(), sun.y()) * std::tan(truth_.sun_sensor.slit_cant_rad);
  // Where |sine| reaches 1, the Sun's circle misses the canted slit.
  return std::abs(sine) < 1.0 ? Due{.azimuth_rad = middle_rad + std::asin(sine), .seen = lit}
                              : Due{.azimuth_rad = middle_rad, .seen = false};
}

template <SpunBody Motion>
auto SpinEdges<Motion>::earth_due(const TrueInfrared& sensor, bool in, const View& view) -> Due {
  const double earth_rad = azimuth_of(view.earth_tipped_km);
  const Due unseen = {.azimuth_rad = earth_rad + sensor.azimuth_rad, .seen = false};
  const Eigen::Vector3d centre = view.squeezed_from_tipped * view.earth_tipped_km;
  const BeamDepth beam{sensor.mount_angle_rad, view.squeezed_from_tipped, centre};
  const auto deepest_rad = beam.deepest_near(earth_rad);
  if (!deepest_rad) {
    return unseen;
  }
  const double outside_rad = *deepest_rad + (in ? -std::numbers::pi : std::numbers::pi);
  // A chord that is empty or a whole turn has no visible edge; its edge is continued from there.
  if (!(beam.at(*deepest_rad).depth > 0.0)) {
    return {.azimuth_rad = *deepest_rad + sensor.azimuth_rad, .seen = false};
  }
  if (!(beam.at(outside_rad).depth < 0.0)) {
    return {.azimuth_rad = outside_rad + sensor.azimuth_rad, .seen = false};
  }
  const double limb_rad = beam.limb_between(*deepest_rad, outside_rad);
  const double late_rad = 0.5 * sensor.chord_excess_rad;
  return {.azimuth_rad = limb_rad + (in ? -late_rad : late_rad) + sensor.azimuth_rad,
          .seen = std::abs(limb_rad - *deepest_rad) >= kNarrowestHalf_rad &&
                  std::abs(outside_rad - limb_rad) >= kNarrowestHalf_rad};
}

template <SpunBody Motion>
auto SpinEdges<Motion>::due(PulseChannel channel, const View& view) const -> Due {
  switch (channel) {
    case PulseChannel::NorthIn:
    case PulseChannel::NorthOut:
      return earth_due(*truth_.north, channel == PulseChannel::NorthIn, view);
    case PulseChannel::SouthIn:
    case PulseChannel::SouthOut:
      return earth_due(*truth_.south, channel == PulseChannel::SouthIn, view);
    default:
      return sun_due(channel, view);
  }
}

/// Finds the crossing within half a turn of the guess by secants, since the lag of the body is
/// nearly linear in time. Only the first lag is wrapped to half a turn and later ones follow it
/// continuously: an edge that moves must not lead to another turn's.
template <SpunBody Motion>
auto SpinEdges<Motion>::crossing_near(PulseChannel channel, double guess_s) -> Expected<Crossing> {
  double t_s = guess_s;
  double slope_rad_s = -truth_.motion.rate_at_rad_s(t_s);
  std::optional<std::pair<double, double>> before;
  double due_rad = truth_.motion.azimuth_rad(t_s);
  for (int i = 0; i < kMostSteps; ++i) {
    const auto seen_from = view(t_s);
    if (!seen_from) {
      return Unexpected{seen_from.error()};
    }
    const Due expected = due(channel, *seen_from);
    due_rad += wrapped_rad(expected.azimuth_rad - due_rad);
    const double lag_rad = due_rad - truth_.motion.azimuth_rad(t_s);
    if (before && std::abs(t_s - before->first) > kSlopeFrom_s) {
      slope_rad_s = (lag_rad - before->second) / (t_s - before->first);
    }
    before = {t_s, lag_rad};
    const double step_s = -lag_rad / slope_rad_s;
    t_s += step_s;
    if (std::abs(step_s) < kConverged_s) {
      return Crossing{.t_s = t_s, .seen = expected.seen};
    }
  }
  // The chord appears or vanishes within this very turn, so it is too narrow to be seen.
  return Crossing{.t_s = guess_s, .seen = false};
}

/// Finds the crossing one turn after the one at `t_s`.
template <SpunBody Motion>
auto SpinEdges<Motion>::crossing_after(PulseChannel channel, double t_s) -> Expected<Crossing> {
  const double guess_s = t_s + kTurn_rad / truth_.motion.rate_at_rad_s(t_s);
  return crossing_near(channel, guess_s).map([&](const Crossing& next) {
    const double turned_rad = truth_.motion.azimuth_rad(next.t_s) - truth_.motion.azimuth_rad(t_s);
    // An edge that moves against the spin as fast as the body turns has no next crossing.
    return turned_rad > kLeastTurn_rad ? next : Crossing{.t_s = guess_s, .seen = false};
  });
}

template <SpunBody Motion>
Expected<void> SpinEdges<Motion>::start() {
  const auto first = view(0.0);
  if (!first) {
    return Unexpected{first.error()};
  }
  std::vector<PulseChannel> channels = {PulseChannel::Sun1, PulseChannel::Sun2};
  if (truth_.north) {
    channels.insert(channels.end(), {PulseChannel::NorthIn, PulseChannel::NorthOut});
  }
  if (truth_.south) {
    channels.insert(channels.end(), {PulseChannel::SouthIn, PulseChannel::SouthOut});
  }
  for (const PulseChannel channel : channels) {
    const double ahead_rad = std::remainder(
        due(channel, *first).azimuth_rad - truth_.motion.azimuth_rad(0.0), kTurn_rad);
    const double guess_s =
        (ahead_rad < 0.0 ? ahead_rad + kTurn_rad : ahead_rad) / truth_.motion.rate_at_rad_s(0.0);
    const auto next = crossing_near(channel, guess_s);
    if (!next) {
      return Unexpected{next.error()};
    }
    followers_.push_back({.channel = channel, .next = *next});
  }
  return {};
}

template <SpunBody Motion>
Expected<void> SpinEdges<Motion>::follow(Follower& follower, double end_s,
                                         std::vector<TrueEdge>& edges) {
  while (follower.next.t_s < end_s) {
    const auto [t_s, seen] = follower.next;
    if (t_s >= 0.0) {
      revolutions_ += follower.channel == PulseChannel::Sun1 ? 1 : 0;
      if (seen) {
        edges.push_back({.t_s = t_s, .channel = follower.channel});
      }
    }
    const auto next = crossing_after(follower.channel, t_s);
    if (!next) {
      return Unexpected{next.error()};
    }
    follower.next = *next;
  }
  return {};
}

template <SpunBody Motion>
Expected<std::vector<TrueEdge>> SpinEdges<Motion>::until(double end_s) {
  if (followers_.empty()) {
    if (const auto begun = start(); !begun) {
      return Unexpected{begun.error()};
    }
  }
  std::vector<TrueEdge> edges;
  for (Follower& follower : followers_) {
    if (const auto followed = follow(follower, end_s, edges); !followed) {
      return Unexpected{followed.error()};
    }
  }
  std::sort(edges.begin(), edges.end(), [](const TrueEdge& a, const TrueEdge& b) {
    return std::tie(a.t_s, a.channel) < std::tie(b.t_s, b.channel);
  });
  return edges;
}

template class SpinEdges<BodySpin>;
template class SpinEdges<SpinMotion>;

}  // namespace spindrift
