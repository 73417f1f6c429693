#include "pipelines/three_axis/rescue_advice.h"

#include <tuple>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

SensorVoice voice_of(const SensorHealth& sensor, TaiTime t) {
  if (!sensor.last_seen) {
    return SensorVoice::Never;
  }
  if (elapsed_s(*sensor.last_seen, t) > RescueAdvice::kSilent_s) {
    return SensorVoice::Silent;
  }
  return sensor.rejected_in_a_row >= RescueAdvice::kLeftOutInARow ? SensorVoice::LeftOut
                                                                  : SensorVoice::Speaks;
}

SensorVoices voices_of(const ThreeAxisConfig& config, const SensorHealths& sensors, TaiTime t) {
  SensorVoices voices;
  const auto tell = [&](bool is_on_board, SampleKind kind) {
    if (is_on_board) {
      voices.at(index_of(kind)) = voice_of(sensors.at(index_of(kind)), t);
    }
  };
  tell(config.gyro.has_value(), SampleKind::Gyro);
  tell(config.star_tracker.has_value(), SampleKind::Star);
  tell(config.sun_sensor.has_value(), SampleKind::Sun);
  tell(config.magnetometer.has_value(), SampleKind::Magnetometer);
  return voices;
}

/// Returns whether two advisories differ by more than their numbers.
bool differ(const Advisory& a, const Advisory& b) {
  const auto gist = [](const Advisory& one) {
    return std::tuple{one.sensors, one.attitude.has_value(), one.certain, one.may_control};
  };
  return gist(a) != gist(b);
}

}  // namespace

void RescueAdvice::see(const AttitudeEstimate& estimate) {
  attitude_ = estimate.assessment.quality == Quality::Lost ? std::nullopt : std::optional{estimate};
}

std::optional<Advisory> RescueAdvice::advise(TaiTime t, const AttitudeGates& gates,
                                             const ThreeAxisConfig& config,
                                             const SensorHealths& sensors) {
  const auto& field = gates.field();
  if (!gates.is_open(Gate::Lost) || !field || elapsed_s(field->t, t) > kSilent_s) {
    given_.reset();
    return std::nullopt;
  }
  if (attitude_ && elapsed_s(attitude_->t, t) > kSilent_s) {
    attitude_.reset();
  }
  Advisory advisory{.t = t,
                    .sensors = voices_of(config, sensors, t),
                    .attitude = attitude_,
                    .off_deg = field->off_deg,
                    .certain = field->certain,
                    .may_control = attitude_.has_value() && gates.is_open(Gate::Safe)};
  if (given_ && elapsed_s(given_->t, t) < kBetween_s && !differ(*given_, advisory)) {
    return std::nullopt;
  }
  given_ = advisory;
  return advisory;
}

}  // namespace spindrift
