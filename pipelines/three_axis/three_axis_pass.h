/// @file
/// Processes the pass of one three-axis spacecraft from samples to products. Live, offline and
/// replay processing all use this one composition of the three-axis pipeline.
///
///     sample -> time order -> gyro, star fix -------------------> attitude
///                          -> sun vector, with the ephemeris --->
///                          -> field, with the main-field model ->
///                          -> orbit state, if the mission has no orbit
///
/// A spacecraft has one star tracker. Without an orbit the Sun is taken as seen from the Earth's
/// centre, an error of one arc minute in geostationary orbit, with unknown eclipses and no field.

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
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/ephemeris/orbit_steps.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/exclusions/exclusions.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/observation/normal_equations.h"
#include "pipelines/three_axis/attitude_action.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "pipelines/three_axis/attitude_gates.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/rescue_advice.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/contested.h"
#include "pipelines/time/reorder_window.h"

namespace spindrift {

struct ThreeAxisOutput {
  std::vector<ThreeAxisProduct> products;  ///< Products in order of their computation.
  std::vector<Notice> notices;             ///< Operator notices, each given once per pass.
};

/// Holds a sample to be ordered. Those of one kind and instant are equal; Contested selects one.
struct OrderedSample {
  TaiTime t;
  /// Alternatives in the order of SampleKind.
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
/// Precondition: both samples are of the same kind.
inline bool say_the_same(const OrderedSample& a, const OrderedSample& b) {
  return std::visit(
      [&]<class Value>(const Value& is) { return say_the_same(is, std::get<Value>(b.is)); }, a.is);
}
/// Returns one second for every sample, as for pulses.
std::chrono::nanoseconds reorder_horizon(const OrderedSample& sample);
inline std::size_t kind_in_order(const OrderedSample& sample) { return index_of(sample.kind()); }

class ThreeAxisPass {
 public:
  /// @param orbit Orbit of the mission file; if empty, received orbit states give it.
  /// @param field Main-field model; if empty, magnetometer samples are rejected.
  ThreeAxisPass(const ThreeAxisConfig& config, std::optional<Orbit> orbit,
                std::optional<MainFieldModel> field = std::nullopt);

  // Precondition: values are valid, vectors and quaternions of unit length within 0.001.
  ThreeAxisOutput push(const GyroSample& sample) { return process({sample.t, sample}); }
  ThreeAxisOutput push(const StarFix& fix) { return process({fix.t, fix}); }
  ThreeAxisOutput push(const SunDirection& sun) { return process({sun.t, sun}); }
  ThreeAxisOutput push(const MagneticField& field) { return process({field.t, field}); }
  ThreeAxisOutput push(const TimedOrbitState& state) { return process({state.t, state}); }

  /// Returns whether operators have excluded the sensor at `t`.
  bool leaves_out(TaiTime t, SampleKind sensor) const { return excluded_.hold(t, sensor); }

  /// Applies an operator's action to telemetry from `t` on that is not yet processed.
  void act(TaiTime t, const AttitudeAction& action);

  /// Processes the samples held back for time ordering. Call this when the stream falls silent;
  /// samples that arrive later with earlier times are then late.
  ThreeAxisOutput fall_silent();

  /// Ends the pass and processes everything that is still held back.
  ThreeAxisOutput finish();

  /// Returns the counts of each sensor up to now.
  const SensorHealths& sensors() const { return estimator_.sensors(); }
  /// Returns what the attitude in force up to now says of the errors of the mission file that act
  /// on its sensors; nothing if there is none.
  NormalEquations normal_equations() const;

 private:
  ThreeAxisOutput process(const OrderedSample& sample);
  void tell_of_mission(ThreeAxisOutput& out) const;
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
  void settle(ThreeAxisOutput& out);
  void judge_answers(std::size_t from, ThreeAxisOutput& out);
  void say_once(Notice notice, ThreeAxisOutput& out);
  void say_what_is_left_out(ThreeAxisOutput& out);
  Notice most_left_out(const RejectedSample& last, double percent) const;

  ThreeAxisConfig config_;
  std::optional<Orbit> orbit_;
  bool orbit_is_of_mission_;
  std::vector<OrbitStep> orbit_steps_;
  std::optional<TaiTime> first_field_;  ///< First field sample compared with the model.
  std::optional<TaiTime> last_field_;
  ApparentSun sun_;
  std::optional<MainFieldModel> field_;
  TurningEarth earth_;
  BasicReorderWindow<OrderedSample> window_;
  Contested<OrderedSample> contested_;
  AttitudeEstimator estimator_;
  AttitudeGates gates_;
  RescueAdvice advice_;
  TaiTime reached_ = {};  ///< Time of the last sample that was computed.
  Exclusions<SampleKind> excluded_;
  std::set<NoticeCode> said_;
  std::map<std::pair<SampleKind, Rejection>, std::int64_t> left_out_;
  std::set<std::pair<SampleKind, Rejection>> said_left_out_;
};

}  // namespace spindrift
