#include "services/publisher/result_publisher.h"

#include <utility>

#include "services/publisher/to_idl.h"

namespace spindrift {

Expected<ResultPublisher> ResultPublisher::create(const bus::Participant& participant,
                                                  std::string service) {
  const bus::Qos qos = bus::results_qos();
  auto spin_fix = bus::Writer<spindrift_SpinFix>::create(participant, bus::kSpinFixTopic, qos);
  if (!spin_fix) {
    return Unexpected{spin_fix.error()};
  }
  auto spin_estimate =
      bus::Writer<spindrift_SpinEstimate>::create(participant, bus::kSpinEstimateTopic, qos);
  if (!spin_estimate) {
    return Unexpected{spin_estimate.error()};
  }
  auto health = bus::Writer<spindrift_Health>::create(participant, bus::kHealthTopic, qos);
  if (!health) {
    return Unexpected{health.error()};
  }
  return ResultPublisher{std::move(service), std::move(*spin_fix), std::move(*spin_estimate),
                         std::move(*health)};
}

Expected<void> ResultPublisher::publish(std::string_view spacecraft, std::string_view run_id,
                                        const SpinFix& fix) const {
  return to_idl({.spacecraft = spacecraft, .run_id = run_id, .service = service_}, fix)
      .and_then([this](const spindrift_SpinFix& sample) { return spin_fix_.write(sample); });
}

Expected<void> ResultPublisher::publish(std::string_view spacecraft, std::string_view run_id,
                                        const SpinEstimate& estimate) const {
  return to_idl({.spacecraft = spacecraft, .run_id = run_id, .service = service_}, estimate)
      .and_then(
          [this](const spindrift_SpinEstimate& sample) { return spin_estimate_.write(sample); });
}

Expected<void> ResultPublisher::publish(const Health& health) const {
  return to_idl(service_, health).and_then([this](const HealthSample& health_sample) {
    return health_.write(health_sample.sample);
  });
}

Expected<std::vector<std::string>> ResultPublisher::incompatible_readers() const {
  std::vector<std::string> all;
  for (const auto& status : {spin_fix_.status(), spin_estimate_.status(), health_.status()}) {
    if (!status) {
      return Unexpected{status.error()};
    }
    all.insert(all.end(), status->incompatible_readers.begin(), status->incompatible_readers.end());
  }
  return all;
}

}  // namespace spindrift
