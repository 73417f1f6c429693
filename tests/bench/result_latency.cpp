/// @file
/// Measures the latency of a running `spindrift serve` from the write of the sample that triggers a
/// result to the committed and published result: a fix of a spinner, an attitude of a three-axis
/// spacecraft, or with `alerts` a raised alert.
///
///     result_latency MISSION.toml TELEMETRY SPACECRAFT SPEED [DOMAIN [alerts]]
///
/// The same pass is sent as SPACECRAFT spacecraft named LOAD-0, LOAD-1, ..., one after the other,
/// SPEED times faster than real time. The pipeline determines beforehand which sample triggers
/// which result. Prints the numbers of expected and of seen results; median, 99th percentile and
/// maximum latency in microseconds; and, like ddsperf, the median of the 99th percentiles of single
/// seconds.

#include <fmt/format.h>
#include <spindrift.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/supervision/attitude_conditions.h"
#include "pipelines/supervision/spin_conditions.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "services/bus/participant.h"
#include "services/bus/reader.h"
#include "services/bus/wait_set.h"
#include "services/mission/mission.h"
#include "services/publisher/product_messages.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/bench/load_support.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

using bench::AnySample;
using bench::or_exit;

/// Identifies a result among those of its spacecraft over all passes that are sent.
std::string identity(TaiTime t) { return std::to_string(tai_ns(t)); }
std::string identity(TaiTime raised, const std::string& key, std::uint32_t revision) {
  return fmt::format("{} {} {}", tai_ns(raised), key, revision);
}

template <class Message>
std::string identity_of(const Message& result, std::chrono::nanoseconds delay) {
  return identity(tai_from_ns(result.t_tai_ns) - delay);
}
std::string identity_of(const spindrift_Alert& alert, std::chrono::nanoseconds delay) {
  return identity(tai_from_ns(alert.raised_tai_ns) - delay, alert.dedupe_key, alert.revision);
}

/// Maps each result to the index of the sample that triggers it.
using Bringing = std::map<std::string, std::size_t>;

/// @param note Called in order with each product and the sample that triggers it.
template <class Pass, class Note>
void for_each_product(Pass pass, const std::vector<AnySample>& samples, const Note& note) {
  const auto push = [&](std::size_t i, const auto& value) {
    if constexpr (requires { pass.push(value); }) {
      for (const auto& product : pass.push(value).products) {
        std::visit([&](const auto& of_kind) { note(of_kind, i); }, product);
      }
    }
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::visit([&](const auto& sample) { push(i, sample.value); }, samples[i]);
  }
}

template <class Result, class Pass>
Bringing bringing_out(const Pass& pass, const std::vector<AnySample>& samples) {
  Bringing bringing;
  for_each_product(pass, samples, [&](const auto& product, std::size_t i) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(product)>, Result>) {
      bringing.emplace(identity(product.t), i);
    }
  });
  return bringing;
}

/// Returns the samples that trigger the alerts of the products.
template <class Pass, class Conditions>
Bringing raising(const Pass& pass, const std::vector<AnySample>& samples, Conditions conditions) {
  Bringing bringing;
  for_each_product(pass, samples, [&](const auto& product, std::size_t i) {
    if constexpr (requires { conditions.evaluate(product); }) {
      for (const ConditionChange& change : conditions.evaluate(product)) {
        if (change.change == Change::Raised) {
          bringing.emplace(identity(change.t, alert_key(change.code, change.about), 1), i);
        }
      }
    }
  });
  return bringing;
}

struct Seen {
  std::size_t spacecraft;
  std::string identity;
  steady_clock::time_point at;
};

/// Returns the quantile `share` of at least one value.
double at_share(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

/// Returns the delay of a pass. The passes begin one after the other within ten seconds, since each
/// settles its first ten revolutions at once. The load then has all phases at any time, and samples
/// sent together were measured together, as in a real pass.
std::chrono::nanoseconds delay(std::size_t spacecraft) {
  // The interval is no fraction of a turn.
  constexpr std::chrono::nanoseconds kApart{100'700'000};
  return spacecraft * kApart;
}

/// Notes every result as it arrives until stopped.
template <class Message>
void listen(const bus::Reader<Message>& reader, const bus::WaitSet& waitset,
            std::vector<Seen>& seen) {
  while (or_exit(waitset.wait())) {
    or_exit(reader.take([&](const Message& result) {
      const std::string name{result.spacecraft};
      const std::size_t spacecraft = std::stoul(name.substr(name.find('-') + 1));
      seen.push_back({.spacecraft = spacecraft,
                      .identity = identity_of(result, delay(spacecraft)),
                      .at = steady_clock::now()});
    }));
  }
}

struct Event {
  double due_s;
  std::size_t spacecraft;
  std::size_t sample;
};

TaiTime time_of(const AnySample& sample) {
  return std::visit([](const auto& is) { return is.value.t; }, sample);
}

std::vector<Event> events(const std::vector<AnySample>& samples, std::size_t spacecraft,
                          double speed) {
  std::vector<Event> all;
  for (std::size_t s = 0; s < spacecraft; ++s) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const TaiTime t = time_of(samples[i]) + delay(s);
      all.push_back({.due_s = seconds_between(time_of(samples.front()), t) / speed,
                     .spacecraft = s,
                     .sample = i});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Event& a, const Event& b) { return a.due_s < b.due_s; });
  return all;
}

/// Holds the publishers of all kinds.
template <class Value>
using PublisherOf = std::optional<TelemetryPublisher<Value>>;
using Publishers = ByKind<PublisherOf>;

Publishers publishers_for(const bus::Participant& participant,
                          const std::vector<AnySample>& samples) {
  Publishers publishers;
  for (const AnySample& sample : samples) {
    std::visit(
        [&]<class Value>(const TelemetrySample<Value>& /*sample*/) {
          if (!publishers.of<Value>()) {
            publishers.of<Value>() =
                or_exit(TelemetryPublisher<Value>::create(participant, "load", 1));
            or_exit(publishers.of<Value>()->wait_for_subscriber(std::chrono::seconds{30}));
          }
        },
        sample);
  }
  return publishers;
}

/// How often and how fast the pass is sent.
struct Load {
  std::size_t spacecraft;
  double speed;
  std::uint32_t domain;
};

template <class Result>
void run(const Bringing& bringing, const std::vector<AnySample>& samples, const Load& load) {
  const auto [spacecraft, speed, domain] = load;
  const auto participant = or_exit(bus::Participant::create({.domain = domain}));
  const auto reader = or_exit(bus::Reader<typename ProductMessage<Result>::Type>::create(
      participant, product_topic<Result>(), bus::results_qos()));
  auto waitset = or_exit(bus::WaitSet::create(participant));
  or_exit(waitset.attach(reader.data()));
  std::vector<Seen> seen;
  seen.reserve(bringing.size() * spacecraft);
  std::thread listener{[&] { listen(reader, waitset, seen); }};

  auto publishers = publishers_for(participant, samples);
  std::vector<std::string> names;
  for (std::size_t s = 0; s < spacecraft; ++s) {
    names.push_back(fmt::format("LOAD-{}", s));
  }
  std::vector<std::vector<steady_clock::time_point>> written(
      spacecraft, std::vector<steady_clock::time_point>(samples.size()));
  const auto start = steady_clock::now();
  for (const Event& event : events(samples, spacecraft, speed)) {
    std::this_thread::sleep_until(start + std::chrono::duration_cast<steady_clock::duration>(
                                              std::chrono::duration<double>{event.due_s}));
    written[event.spacecraft][event.sample] = steady_clock::now();
    std::visit(
        [&]<class Value>(TelemetrySample<Value> sample) {
          sample.value.t += delay(event.spacecraft);
          or_exit(publishers.of<Value>()->publish(names[event.spacecraft], sample.value,
                                                  std::stop_token{}));
        },
        samples[event.sample]);
  }
  std::this_thread::sleep_for(std::chrono::seconds{2});
  waitset.stop();
  listener.join();

  std::vector<double> taken_us;
  std::map<std::chrono::seconds, std::vector<double>> of_second_us;
  for (const Seen& result : seen) {
    if (const auto sample = bringing.find(result.identity); sample != bringing.end()) {
      const auto from = written[result.spacecraft][sample->second];
      taken_us.push_back(std::chrono::duration<double, std::micro>(result.at - from).count());
      of_second_us[std::chrono::floor<std::chrono::seconds>(from - start)].push_back(
          taken_us.back());
    }
  }
  if (taken_us.empty()) {
    fmt::print(stderr, "result_latency: no result was seen\n");
    std::exit(1);
  }
  std::vector<double> p99_of_seconds_us;
  for (auto& [second, us] : of_second_us) {
    p99_of_seconds_us.push_back(at_share(us, 0.99));
  }
  fmt::print("{} {} {:.0f} {:.0f} {:.0f} {:.0f}\n", bringing.size() * spacecraft, taken_us.size(),
             at_share(taken_us, 0.5), at_share(taken_us, 0.99), at_share(taken_us, 1.0),
             at_share(p99_of_seconds_us, 0.5));
}

template <class Result, class Pass, class Conditions>
void run(const Pass& pass, const Conditions& conditions, const std::vector<AnySample>& samples,
         const Load& load, bool is_of_alerts) {
  if (is_of_alerts) {
    run<Alert>(raising(pass, samples, conditions), samples, load);
  } else {
    run<Result>(bringing_out<Result>(pass, samples), samples, load);
  }
}

void run(const std::string& mission_file, const std::string& telemetry, const Load& load,
         bool is_of_alerts) {
  const Mission mission = or_exit(load_mission(mission_file));
  const std::vector<AnySample> samples = bench::read_samples(telemetry, mission.spacecraft_id);
  if (const SpinConfig* const spin = mission.spin()) {
    run<SpinFix>(SpinPass{*spin, *mission.orbit},
                 SpinConditions{*spin, *mission.orbit, mission.alerts, mission.target}, samples,
                 load, is_of_alerts);
  } else {
    run<AttitudeEstimate>(ThreeAxisPass{std::get<ThreeAxisConfig>(mission.config), mission.orbit},
                          AttitudeConditions{mission.alerts, mission.orbit}, samples, load,
                          is_of_alerts);
  }
}

}  // namespace
}  // namespace spindrift

int main(int argc, char** argv) {
  const std::span<char*> arguments{argv, static_cast<std::size_t>(argc)};
  const bool is_of_alerts = arguments.size() == 7 && std::string{arguments[6]} == "alerts";
  if (arguments.size() < 5 || arguments.size() > (is_of_alerts ? 7U : 6U)) {
    fmt::print(stderr,
               "usage: result_latency MISSION.toml TELEMETRY SPACECRAFT SPEED [DOMAIN [alerts]]\n");
    return 2;
  }
  spindrift::run(
      arguments[1], arguments[2],
      {.spacecraft = std::stoul(arguments[3]),
       .speed = std::stod(arguments[4]),
       .domain = arguments.size() > 5 ? static_cast<std::uint32_t>(std::stoul(arguments[5])) : 0},
      is_of_alerts);
  return 0;
}
