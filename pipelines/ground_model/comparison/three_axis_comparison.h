/// @file
/// Telemetry of a three-axis spacecraft against what its sensors would read, without noise, were
/// it to turn as the model does.
///
/// | channel | unit | what |
/// |---|---|---|
/// | `gyro_x`, `_y`, `_z` | deg/s | body rates, the bias of the model's gyro included |
/// | `star_x`, `_y`, `_z` | deg | small turn from the model's attitude to flight's, body axes |
/// | `sun_x`, `sun_y` | deg | from the model's Sun to flight's, along X and Y as they are turned
/// with -Z to the model's Sun | | `magnetometer_x`, `_y`, `_z` | nT | field, body axes, the bias of
/// the model's magnetometer included | | `gyro`, `star`, `sun`, `magnetometer` | | whether the
/// sensor sends |

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/ground_model/comparison/compared_sample.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// How a body should turn, and what its sensors should tell of it.
struct ThreeAxisModel {
  TaiTime start;
  BodyMotion motion;
  ThreeAxisSensors sensors;  ///< Biases as they are; noise, by which flight is judged, above 0.
  std::vector<Silence> gyro_gaps;
  Orbit orbit;
};

/// The flight as it is flown, its seed included: a bias that is not given is the one drawn, and so
/// is what a law on board reads of its gyro.
/// @return as flown; InvalidConfiguration for a sensor without noise.
Expected<ThreeAxisModel> three_axis_model(const SeparationScenario& scenario, const Orbit& orbit);
Expected<ThreeAxisModel> three_axis_model(const TumblingScenario& scenario, const Orbit& orbit);
Expected<ThreeAxisModel> three_axis_model(const OrientationScenario& scenario, const Orbit& orbit);

/// Each sample against the model at the sample's own time, in any order. A sensor is missed that
/// gives nothing for one and a half of its steps while others send; of a Sun that the model's
/// sensor does not see, and in a gap of its gyro, nothing is. Samples outside the model's time, or
/// of sensors that it has not, give nothing.
class ThreeAxisComparison {
 public:
  /// @param model Outlives it.
  explicit ThreeAxisComparison(const ThreeAxisModel& model);

  std::vector<ComparedChannel> channels() const;

  std::vector<ComparedSample> see(const GyroSample& sample);
  std::vector<ComparedSample> see(const StarFix& fix);
  std::vector<ComparedSample> see(const SunDirection& sun);
  std::vector<ComparedSample> see(const MagneticField& field);

 private:
  struct Sensor {
    SampleKind kind;
    Sampling sampling;
    double sigma;  ///< Along or about each axis, in the unit.
    std::string_view unit;
    int values;                         ///< Components.
    std::size_t channel;                ///< Of the sensor as a whole; its components follow.
    std::optional<double> last_s = {};  ///< Sample, or when nothing was expected; behind the start.
  };

  void add(SampleKind kind, const Sampling& sampling, double sigma, std::string_view unit,
           int values);
  Sensor* find(SampleKind kind);
  std::optional<double> time_s(TaiTime t) const;
  std::vector<ComparedSample> compared(SampleKind kind, TaiTime t,
                                       const std::vector<double>& flight,
                                       const std::vector<double>& model);
  void note_missing(TaiTime t, double t_s, std::vector<ComparedSample>& all);
  bool sends(const Sensor& sensor, double t_s);
  std::optional<Eigen::Vector3d> sun_body(TaiTime t, double t_s);

  const ThreeAxisModel* model_;
  std::vector<Sensor> sensors_;
  std::size_t channels_ = 0;
  std::optional<double> newest_s_;
  ApparentSun sun_;
  TurningEarth earth_;
};

}  // namespace spindrift
