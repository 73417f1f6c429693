/// @file
/// The pass of one three-axis spacecraft: samples in, products out. The one composition of the
/// three-axis pipeline, run alike live, offline and in replay.
///
///     sample -> order of time -> gyro, star fix ------------------> attitude
///                             -> sun vector, beside the ephemeris ->
///                             -> field, beside the main field ------>
///                             -> orbit state, where the mission has no orbit
///
/// One star tracker a spacecraft. Without an orbit the Sun is where the Earth's centre sees it, off
/// by an arc minute in the geostationary ring, no shadow is known, and no field.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/core/notice.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/ephemeris/timed_orbit_state.h"
#include "pipelines/exclusions/exclusions.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/three_axis/attitude_action.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/magnetic_field.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/contested.h"
#include "pipelines/time/reorder_window.h"

namespace spindrift {

struct ThreeAxisOutput {
  std::vector<ThreeAxisProduct> products;  ///< In the order they arose.
  std::vector<Notice> notices;             ///< What a person should know; each said once a pass.
};

/// Any sample in its place: those of one kind and instant are one (Contested says which counts).
struct OrderedSample {
  TaiTime t;
  /// As SampleKind.
  std::variant<TimedOrbitState, GyroSample, StarFix, SunDirection, MagneticField> is;

  SampleKind kind() const { return static_cast<SampleKind>(is.index()); }
  friend auto operator<=>(const OrderedSample& a, const OrderedSample& b) {
    return std::pair{a.t, a.is.index()} <=> std::pair{b.t, b.is.index()};
  }
  friend bool operator==(const OrderedSample& a, const OrderedSample& b) { return (a <=> b) == 0; }
};
inline Sender sender_of(const OrderedSample& sample) {
  return std::visit([](const auto& is) { return is.sender; }, sample.is);
}
/// Of two of one kind.
inline bool say_the_same(const OrderedSample& a, const OrderedSample& b) {
  return std::visit(
      [&]<class Value>(const Value& is) { return say_the_same(is, std::get<Value>(b.is)); }, a.is);
}
/// A second, as for pulses.
std::chrono::nanoseconds reorder_horizon(const OrderedSample& sample);
inline std::size_t kind_in_order(const OrderedSample& sample) { return index_of(sample.kind()); }

class ThreeAxisPass {
 public:
  /// @param orbit Of the mission file; empty: states on the way say it.
  /// @param field The Earth's; empty: a magnetometer tells nothing.
  ThreeAxisPass(const ThreeAxisConfig& config, std::optional<Orbit> orbit,
                std::optional<MainFieldModel> field = std::nullopt);

  // What is no number, no unit vector or quaternion within 0.001, or no field, does not come here.
  ThreeAxisOutput push(const GyroSample& sample) { return take({sample.t, sample}); }
  ThreeAxisOutput push(const StarFix& fix) { return take({fix.t, fix}); }
  ThreeAxisOutput push(const SunDirection& sun) { return take({sun.t, sun}); }
  ThreeAxisOutput push(const MagneticField& field) { return take({field.t, field}); }
  ThreeAxisOutput push(const TimedOrbitState& state) { return take({state.t, state}); }

  /// An operator's word on telemetry from `t` on: on what is not computed yet.
  void act(TaiTime t, const AttitudeAction& action);

  /// Nothing comes for now: what is held back for the order of time is computed, and what comes
  /// from before that later is late.
  ThreeAxisOutput fall_silent();

  /// The pass has ended: settles all that is still held.
  ThreeAxisOutput finish();

  /// Up to now.
  const SensorHealths& sensors() const { return estimator_.sensors(); }

 private:
  ThreeAxisOutput take(const OrderedSample& sample);
  void compare(const OrderedSample& again, ThreeAxisOutput& out);
  void compute(const std::vector<OrderedSample>& in_order, ThreeAxisOutput& out);
  std::optional<OrderedSample> settled(const OrderedSample& due, ThreeAxisOutput& out);
  void compute(const TimedOrbitState& state, ThreeAxisOutput& out);
  void compute(const GyroSample& sample, ThreeAxisOutput& out);
  void compute(const StarFix& fix, ThreeAxisOutput& out);
  void compute(const SunDirection& sun, ThreeAxisOutput& out);
  void compute(const MagneticField& field, ThreeAxisOutput& out);
  Expected<OrbitState> spacecraft_at(TaiTime t) const;
  void leave_out(const OrderedSample& sample, Rejection rejected_by, ThreeAxisOutput& out);
  bool has_sensor(SampleKind kind) const;
  void doubt_where_orbit_steps(ThreeAxisOutput& out);
  void say_once(Notice notice, ThreeAxisOutput& out);
  void say_what_is_left_out(ThreeAxisOutput& out);
  Notice most_left_out(const RejectedSample& last, double percent) const;

  ThreeAxisConfig config_;
  std::optional<Orbit> orbit_;
  bool orbit_is_of_mission_;
  std::vector<OrbitStep> orbit_steps_;
  std::optional<TaiTime> first_field_;  ///< That was compared with the Earth's along the orbit.
  std::optional<TaiTime> last_field_;
  ApparentSun sun_;
  std::optional<MainFieldModel> field_;
  TurningEarth earth_;
  BasicReorderWindow<OrderedSample> window_;
  Contested<OrderedSample> contested_;
  AttitudeEstimator estimator_;
  Exclusions<SampleKind> excluded_;
  std::set<NoticeCode> said_;
  std::map<std::pair<SampleKind, Rejection>, std::int64_t> left_out_;
  std::set<std::pair<SampleKind, Rejection>> said_left_out_;
};

}  // namespace spindrift
