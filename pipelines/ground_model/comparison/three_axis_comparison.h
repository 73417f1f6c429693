/// @file
/// Comparison of the telemetry of a three-axis spacecraft with what its sensors would read, without
/// noise, if it turned as the model does.
///
/// | channel | unit | what |
/// |---|---|---|
/// | `gyro_x`, `_y`, `_z` | deg/s | body rates, including the bias of the model's gyro |
/// | `star_x`, `_y`, `_z` | deg | small turn from the model's attitude to flight's, body axes |
/// | `sun_x`, `sun_y` | deg | angle from the model's Sun to flight's |
/// | `magnetometer_x`, `_y`, `_z` | nT | field, body axes, including the model's bias |
/// | `gyro`, `star`, `sun`, `magnetometer` | | whether the sensor sends |
///
/// `sun_x` and `sun_y` are along X and Y after the smallest turn of -Z to the model's Sun.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/ground_model/comparison/departure_watch.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// Predicted motion of a body, and the sensors that observe it.
struct ThreeAxisModel {
  TaiTime start;
  BodyMotion motion;
  ThreeAxisSensors sensors;  ///< True biases, and the noise by which flight is judged; above 0.
  std::vector<Silence> gyro_gaps;
  Orbit orbit;
};

/// Flies the scenario with its own seed: a bias that is not given is the one drawn, and a control
/// law on board reads the gyro as in that flight.
/// @return Errors of `flown`; InvalidConfiguration for a sensor without noise.
Expected<ThreeAxisModel> three_axis_model(const SeparationScenario& scenario, const Orbit& orbit);
Expected<ThreeAxisModel> three_axis_model(const TumblingScenario& scenario, const Orbit& orbit);
Expected<ThreeAxisModel> three_axis_model(const OrientationScenario& scenario, const Orbit& orbit);
Expected<ThreeAxisModel> three_axis_model(const RescueScenario& scenario, const Orbit& orbit);

/// Compares each sample with the model at the sample's own time, in any order. A sensor is missing
/// that gives nothing for one and a half of its steps while others send, unless the model's sun
/// sensor sees no Sun or its gyro is in a gap. Samples outside the model's time, or of sensors it
/// lacks, give nothing.
class ThreeAxisComparison {
 public:
  /// @param model Must outlive this object.
  explicit ThreeAxisComparison(const ThreeAxisModel& model);

  std::vector<ComparedChannel> channels() const;

  std::vector<ComparedSample> compare(const GyroSample& sample);
  std::vector<ComparedSample> compare(const StarFix& fix);
  std::vector<ComparedSample> compare(const SunDirection& sun);
  std::vector<ComparedSample> compare(const MagneticField& field);

 private:
  struct Sensor {
    SampleKind kind;
    Sampling sampling;
    double sigma;  ///< Standard deviation along or about each axis, in `unit`.
    std::string_view unit;
    int values;           ///< Number of components.
    std::size_t channel;  ///< Channel of the whole sensor; its components follow.
    /// Time since the start of its last sample, or when none was due.
    std::optional<double> last_s = {};
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
