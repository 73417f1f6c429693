/// @file
/// Samples of all kinds of a recorded pass, and a front-end that sends them in any order.

#pragma once

#include <chrono>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "services/bus/participant.h"
#include "services/program/telemetry_output.h"
#include "services/telemetry/telemetry_files.h"
#include "services/telemetry/telemetry_stream.h"

namespace spindrift {

using AnySample = TelemetryKinds::Of<std::variant, TelemetrySample>;

/// Returns the samples of a recorded pass in order of time, all of the source "front-end".
inline std::vector<AnySample> samples_in(const std::filesystem::path& pass,
                                         const std::string& spacecraft) {
  const std::vector<std::filesystem::path> paths{pass};
  auto stream = TelemetryStream::open(scan_telemetry(paths).value(), spacecraft).value();
  std::vector<AnySample> all;
  for (auto batch = stream.next().value(); !is_empty(batch); batch = stream.next().value()) {
    in_order_of_arrival(batch.samples, [&](auto& sample) {
      sample.origin.source = "front-end";
      all.emplace_back(std::move(sample));
    });
  }
  return all;
}

/// Sends samples of any kinds as one source, in the order given.
class AnyFrontEnd {
 public:
  AnyFrontEnd(const bus::BusConfig& bus, std::vector<AnySample> samples)
      : participant_{bus::Participant::create(bus).value()}, samples_{std::move(samples)} {
    const std::uint64_t session = random_session();
    for (const AnySample& sample : samples_) {
      std::visit(
          [&]<class Value>(const TelemetrySample<Value>& /*of_kind*/) {
            if (auto& publisher = publishers_.of<Value>(); !publisher) {
              publisher.emplace(
                  TelemetryPublisher<Value>::create(participant_, "front-end", session).value());
            }
          },
          sample);
    }
  }

  /// Sends all samples, with a pause before each.
  /// @return False if there is no subscriber.
  bool send(std::chrono::microseconds pause) {
    bool done = with_each([](const auto& publisher) {
      return publisher.wait_for_subscriber(std::chrono::seconds{30}).has_value();
    });
    for (auto sample = samples_.begin(); done && sample != samples_.end(); ++sample) {
      std::this_thread::sleep_for(pause);
      done = std::visit(
          [&]<class Value>(const TelemetrySample<Value>& one) {
            return publishers_.of<Value>()
                ->publish(one.spacecraft, one.value, std::stop_token{})
                .has_value();
          },
          *sample);
    }
    return done && with_each([](const auto& publisher) {
             return publisher.wait_for_acknowledgments(std::chrono::seconds{30}).has_value();
           });
  }

 private:
  template <class Attempt>
  bool with_each(const Attempt& attempt) const {
    bool done = true;
    publishers_.for_each(
        [&](const auto& publisher) { done = done && (!publisher || attempt(*publisher)); });
    return done;
  }

  bus::Participant participant_;
  TelemetryPublishers publishers_;
  std::vector<AnySample> samples_;
};

}  // namespace spindrift
