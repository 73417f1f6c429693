/// @file
/// How long it takes from the write of the edge that closes a revolution to its fix, committed and
/// published, at a running `spindrift serve`.
///
///     fix_latency MISSION.toml PULSES.csv SPACECRAFT SPEED [DOMAIN]
///
/// The same pass goes out as SPACECRAFT spacecraft named LOAD-0, LOAD-1, ..., one after the other,
/// SPEED times faster than it was. Which edge brings out which fix, the pipeline itself tells
/// beforehand. Prints revolutions, those whose fix was seen; median, 99th percentile and longest in
/// microseconds; and the median over seconds of the 99th percentile in each, as ddsperf has it.

#include <fmt/format.h>
#include <spindrift.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pipelines/spin/pass/spin_pass.h"
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

using bench::or_exit;

/// Time of a fix, and the pulse that brings it out.
std::map<TaiTime, std::size_t> closing_pulses(const Mission& mission,
                                              const std::vector<Pulse>& pulses) {
  std::map<TaiTime, std::size_t> closing;
  SpinPass pass{*mission.spin(), *mission.orbit};
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    for (const SpinProduct& product : pass.push(pulses[i]).products) {
      if (const auto* fix = std::get_if<SpinFix>(&product)) {
        closing.emplace(fix->t, i);
      }
    }
  }
  return closing;
}

struct Seen {
  std::size_t spacecraft;
  TaiTime t;
  steady_clock::time_point at;
};

/// Of at least one value.
double at_share(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

/// Notes every fix as it arrives, until stopped.
void listen(const bus::Reader<spindrift_SpinFix>& reader, const bus::WaitSet& waitset,
            std::vector<Seen>& seen) {
  while (or_exit(waitset.wait())) {
    or_exit(reader.take([&](const spindrift_SpinFix& fix) {
      const std::string name{fix.spacecraft};
      seen.push_back({.spacecraft = std::stoul(name.substr(name.find('-') + 1)),
                      .t = tai_from_ns(fix.t_tai_ns),
                      .at = steady_clock::now()});
    }));
  }
}

struct Event {
  double due_s;
  std::size_t spacecraft;
  std::size_t pulse;
};

/// The passes begin one after the other, all within ten seconds, since each settles its first ten
/// revolutions at once. At any time the load has all phases, and as in a pass what is sent together
/// was measured together.
std::chrono::nanoseconds delay(std::size_t spacecraft) {
  // No part of a turn.
  constexpr std::chrono::nanoseconds kApart{100'700'000};
  return spacecraft * kApart;
}

std::vector<Event> events(const std::vector<Pulse>& pulses, std::size_t spacecraft, double speed) {
  std::vector<Event> all;
  for (std::size_t s = 0; s < spacecraft; ++s) {
    for (std::size_t i = 0; i < pulses.size(); ++i) {
      const TaiTime t = pulses[i].t + delay(s);
      all.push_back(
          {.due_s = seconds_between(pulses.front().t, t) / speed, .spacecraft = s, .pulse = i});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Event& a, const Event& b) { return a.due_s < b.due_s; });
  return all;
}

void run(const std::string& mission_file, const std::string& pulses_file, std::size_t spacecraft,
         double speed, std::uint32_t domain) {
  const Mission mission = or_exit(load_mission(mission_file));
  const std::vector<Pulse> pulses = bench::read_pulses(pulses_file);
  const std::map<TaiTime, std::size_t> closing = closing_pulses(mission, pulses);

  const auto participant = or_exit(bus::Participant::create({.domain = domain}));
  const auto reader = or_exit(bus::Reader<spindrift_SpinFix>::create(
      participant, product_topic<SpinFix>(), bus::results_qos()));
  auto waitset = or_exit(bus::WaitSet::create(participant));
  or_exit(waitset.attach(reader.data()));
  std::vector<Seen> seen;
  seen.reserve(closing.size() * spacecraft);
  std::thread listener{[&] { listen(reader, waitset, seen); }};

  auto publisher = or_exit(TelemetryPublisher<Pulse>::create(participant, "load"));
  or_exit(publisher.wait_for_subscriber(std::chrono::seconds{30}));
  std::vector<std::string> names;
  for (std::size_t s = 0; s < spacecraft; ++s) {
    names.push_back(fmt::format("LOAD-{}", s));
  }
  std::vector<std::vector<steady_clock::time_point>> written(
      spacecraft, std::vector<steady_clock::time_point>(pulses.size()));
  const auto start = steady_clock::now();
  for (const Event& event : events(pulses, spacecraft, speed)) {
    std::this_thread::sleep_until(start + std::chrono::duration_cast<steady_clock::duration>(
                                              std::chrono::duration<double>{event.due_s}));
    written[event.spacecraft][event.pulse] = steady_clock::now();
    Pulse pulse = pulses[event.pulse];
    pulse.t += delay(event.spacecraft);
    or_exit(publisher.publish(names[event.spacecraft], pulse, std::stop_token{}));
  }
  std::this_thread::sleep_for(std::chrono::seconds{2});
  waitset.stop();
  listener.join();

  std::vector<double> taken_us;
  std::map<std::chrono::seconds, std::vector<double>> of_second_us;
  for (const Seen& fix : seen) {
    const TaiTime t = fix.t - delay(fix.spacecraft);
    if (const auto edge = closing.find(t); edge != closing.end()) {
      const auto from = written[fix.spacecraft][edge->second];
      taken_us.push_back(std::chrono::duration<double, std::micro>(fix.at - from).count());
      of_second_us[std::chrono::floor<std::chrono::seconds>(from - start)].push_back(
          taken_us.back());
    }
  }
  if (taken_us.empty()) {
    fmt::print(stderr, "fix_latency: no fix was seen\n");
    std::exit(1);
  }
  std::vector<double> p99_of_seconds_us;
  for (auto& [second, us] : of_second_us) {
    p99_of_seconds_us.push_back(at_share(us, 0.99));
  }
  fmt::print("{} {} {:.0f} {:.0f} {:.0f} {:.0f}\n", closing.size() * spacecraft, taken_us.size(),
             at_share(taken_us, 0.5), at_share(taken_us, 0.99), at_share(taken_us, 1.0),
             at_share(p99_of_seconds_us, 0.5));
}

}  // namespace
}  // namespace spindrift

int main(int argc, char** argv) {
  const std::span<char*> arguments{argv, static_cast<std::size_t>(argc)};
  if (arguments.size() < 5) {
    fmt::print(stderr, "usage: fix_latency MISSION.toml PULSES.csv SPACECRAFT SPEED [DOMAIN]\n");
    return 2;
  }
  spindrift::run(arguments[1], arguments[2], std::stoul(arguments[3]), std::stod(arguments[4]),
                 arguments.size() > 5 ? static_cast<std::uint32_t>(std::stoul(arguments[5])) : 0);
  return 0;
}
