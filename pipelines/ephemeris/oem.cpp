#include "pipelines/ephemeris/oem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <span>
#include <string>

#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

constexpr std::size_t kMaxConditions = kMaxInterpolationDegree + 1;

std::string_view key_of(Interpolation interpolation) {
  return interpolation == Interpolation::Lagrange ? "LAGRANGE" : "HERMITE";
}

std::size_t window_size(const OemSegment& segment) {
  return static_cast<std::size_t>(points_needed(segment.interpolation, segment.degree));
}

/// Returns what is wrong with a segment by itself; empty: nothing.
std::string fault_of(const OemSegment& segment) {
  if (segment.degree < 1 || segment.degree > kMaxInterpolationDegree) {
    return fmt::format("INTERPOLATION_DEGREE = {}: must lie in 1 to {}", segment.degree,
                       kMaxInterpolationDegree);
  }
  const std::size_t needed = window_size(segment);
  if (segment.points.size() < needed) {
    return fmt::format("INTERPOLATION = {} of degree {} needs {} data lines, there are {}",
                       key_of(segment.interpolation), segment.degree, needed,
                       segment.points.size());
  }
  const auto not_later =
      std::adjacent_find(segment.points.begin(), segment.points.end(),
                         [](const auto& a, const auto& b) { return !(a.t < b.t); });
  if (not_later != segment.points.end()) {
    return fmt::format("the data line after {} must be later than it", format_utc(not_later->t, 9));
  }
  if (segment.usable_from > segment.usable_to || segment.usable_from < segment.points.front().t ||
      segment.usable_to > segment.points.back().t) {
    return fmt::format("usable from {} to {}: must lie in order within the data lines, {} to {}",
                       format_utc(segment.usable_from, 9), format_utc(segment.usable_to, 9),
                       format_utc(segment.points.front().t, 9),
                       format_utc(segment.points.back().t, 9));
  }
  return {};
}

struct ValueAndSlope {
  Eigen::Vector3d value;
  Eigen::Vector3d slope;
};

/// A polynomial in Newton's form about times relative to the instant asked for, which is 0.
struct NewtonForm {
  std::array<double, kMaxConditions> nodes_s{};
  std::array<Eigen::Vector3d, kMaxConditions> coefficients{};
  std::size_t size = 0;

  void add(double node_s, const Eigen::Vector3d& value) {
    nodes_s.at(size) = node_s;
    coefficients.at(size) = value;
    ++size;
  }
  /// Computes divided differences, in place, of `first_order` and higher.
  void divide_differences(std::size_t first_order) {
    for (std::size_t order = first_order; order < size; ++order) {
      for (std::size_t i = size - 1; i >= order; --i) {
        coefficients[i] =
            (coefficients[i] - coefficients[i - 1]) / (nodes_s[i] - nodes_s[i - order]);
      }
    }
  }
  /// Returns value and first derivative at the instant asked for.
  ValueAndSlope evaluate() const {
    Eigen::Vector3d value = coefficients[size - 1];
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    for (std::size_t i = size - 1; i-- > 0;) {
      slope = value - nodes_s[i] * slope;
      value = coefficients[i] - nodes_s[i] * value;
    }
    return {.value = value, .slope = slope};
  }
};

OrbitState lagrange_at(TaiTime t, std::span<const EphemerisPoint> window) {
  NewtonForm position;
  NewtonForm velocity;
  for (const EphemerisPoint& point : window) {
    const double node_s = seconds_between(t, point.t);
    position.add(node_s, point.state.position_icrf_km);
    velocity.add(node_s, point.state.velocity_icrf_km_s);
  }
  position.divide_differences(1);
  velocity.divide_differences(1);
  return {.position_icrf_km = position.evaluate().value,
          .velocity_icrf_km_s = velocity.evaluate().value};
}

OrbitState hermite_at(TaiTime t, std::span<const EphemerisPoint> window) {
  // Every node counts twice; the first-order difference of a node with itself is the velocity.
  NewtonForm form;
  const EphemerisPoint* last = nullptr;
  for (const EphemerisPoint& point : window) {
    const double node_s = seconds_between(t, point.t);
    form.add(node_s,
             last == nullptr
                 ? point.state.position_icrf_km
                 : Eigen::Vector3d{(point.state.position_icrf_km - last->state.position_icrf_km) /
                                   seconds_between(last->t, point.t)});
    form.add(node_s, point.state.velocity_icrf_km_s);
    last = &point;
  }
  form.divide_differences(2);
  const ValueAndSlope at_t = form.evaluate();
  return {.position_icrf_km = at_t.value, .velocity_icrf_km_s = at_t.slope};
}

/// Returns the points about `t`, as many before as after where the segment allows: the window
/// changes only at a node, where the old polynomial and the new one agree.
std::span<const EphemerisPoint> window_about(TaiTime t, const OemSegment& segment) {
  const std::span<const EphemerisPoint> points{segment.points};
  const auto after = std::upper_bound(
      points.begin(), points.end(), t,
      [](TaiTime instant, const EphemerisPoint& point) { return instant < point.t; });
  const auto index_after = static_cast<std::size_t>(std::distance(points.begin(), after));
  const std::size_t size = window_size(segment);
  const std::size_t half = size / 2;
  const std::size_t first = index_after < half ? 0 : index_after - half;
  return points.subspan(std::min(first, points.size() - size), size);
}

Unexpected no_coverage(TaiTime t, const std::string& where) {
  return Unexpected{
      {ErrorCode::NoCoverage, fmt::format("no orbit at {}: {}", format_utc(t), where)}};
}

}  // namespace

Expected<OrbitEphemeris> OrbitEphemeris::make(std::vector<OemSegment> segments) {
  const auto refused = [](std::size_t segment, const std::string& fault) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("orbit ephemeris, segment {}: {}", segment, fault)}};
  };
  if (segments.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration, "orbit ephemeris: there is no segment"}};
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (const std::string fault = fault_of(segments[i]); !fault.empty()) {
      return refused(i + 1, fault);
    }
    if (i > 0 && segments[i].usable_from < segments[i - 1].usable_to) {
      return refused(i + 1, fmt::format("usable from {}: must not begin before the segment before "
                                        "it ends, {}",
                                        format_utc(segments[i].usable_from, 9),
                                        format_utc(segments[i - 1].usable_to, 9)));
    }
  }
  return OrbitEphemeris{std::move(segments)};
}

Expected<OrbitState> OrbitEphemeris::at(TaiTime t) const {
  const auto next = std::upper_bound(
      segments_.begin(), segments_.end(), t,
      [](TaiTime instant, const OemSegment& segment) { return instant < segment.usable_from; });
  if (next == segments_.begin()) {
    return no_coverage(
        t, fmt::format("{:.9g} s before the ephemeris begins", seconds_between(t, usable_from())));
  }
  const OemSegment& segment = *std::prev(next);
  if (t > segment.usable_to) {
    const double past_s = seconds_between(segment.usable_to, t);
    return no_coverage(
        t,
        next == segments_.end()
            ? fmt::format("{:.9g} s after the ephemeris ends", past_s)
            : fmt::format("in a gap, {:.9g} s after one segment ends and {:.9g} s before the next",
                          past_s, seconds_between(t, next->usable_from)));
  }
  const std::span<const EphemerisPoint> window = window_about(t, segment);
  return segment.interpolation == Interpolation::Lagrange ? lagrange_at(t, window)
                                                          : hermite_at(t, window);
}

}  // namespace spindrift
