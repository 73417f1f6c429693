/// @file
/// The tables of faults of a spinner.

#pragma once

#include <fmt/format.h>

#include "tests/property/alerts/fault.h"

namespace spindrift::testing {

/// Returns deploy/scenarios/gto-nominal.toml at a rate at which a second is no whole turn.
inline std::string spinner_text() {
  return replaced(text_of(scenarios() / "gto-nominal.toml"), "rate_rpm = 60.0", "rate_rpm = 55.0");
}

/// The channel goes on by a clock of its own.
inline Spoil runs_free(std::set<PulseChannel> channels, double faster) {
  return moved(of(std::move(channels)), [faster](double t_s) { return -faster * t_s; });
}

inline Spoil swapped(PulseChannel one, PulseChannel other) {
  return changed<Pulse>([=](Pulse& edge, double /*t_s*/) {
    edge.channel = edge.channel == one ? other : edge.channel == other ? one : edge.channel;
  });
}

/// Cuts the times of a channel to whole steps.
inline Spoil cut(PulseChannel channel, std::int64_t step_ns) {
  return [=](std::vector<Sent>& sent, const Window& window) {
    changed<Pulse>([=](Pulse& edge, double /*t_s*/) {
      if (edge.channel == channel) {
        edge.t = tai_from_ns(tai_ns(edge.t) / step_ns * step_ns);
      }
    })(sent, window);
  };
}

/// Adds a north_in edge half a millisecond after each sun2 edge.
inline void interfere(std::vector<Sent>& sent, const Window& window) {
  std::vector<Sent> more;
  for (const Sent& one : sent) {
    if (window.has(time_in_s(one, sent)) && of({PulseChannel::Sun2})(one)) {
      more.push_back(one);
      Pulse& beside = *value_in<Pulse>(more.back());
      beside = {.t = shifted(beside.t, 5e-4), .channel = PulseChannel::NorthIn};
      more.back().came = beside.t;
    }
  }
  sent.insert(sent.end(), more.begin(), more.end());
  sort(sent);
}

/// Every other edge of a channel is off.
inline Spoil alternating(PulseChannel channel, double off_s) {
  const auto is_of_it = [channel, turns = 0](const Sent& one) mutable {
    return of({channel})(one) && ++turns % 2 == 0;
  };
  return moved(is_of_it, off_s);
}

/// The samples of the window are those of another pass.
inline Spoil flown_as(const std::string& scenario) {
  return [scenario](std::vector<Sent>& sent, const Window& window) {
    const TaiTime start = sent.front().came;
    const auto is_in = [&](const Sent& one) {
      return window.has(seconds_between(start, one.came));
    };
    std::erase_if(sent, is_in);
    for (const Sent& one : flown(scenario).sent) {
      if (is_in(one)) {
        sent.push_back(one);
      }
    }
    sort(sent);
  };
}

inline std::vector<Fault> spin_faults() {
  using enum PulseChannel;
  const std::string spinner = spinner_text();
  const std::string target = "\n[spin.target]\nra_deg = 100.0\ndec_deg = -55.0\n";
  const Window minute{.from_s = 200.0, .until_s = 260.0};
  const Spoil turned = flown_as(replaced(spinner, "dec_deg = -55.0", "dec_deg = -45.0"));
  const std::string near_beams = replaced(spinner, "azimuth_deg = 92.0", "azimuth_deg = 100.0") +
                                 "\n[spin.screening]\ninterference_s = 0.002\n";
  const std::string nutating = replaced(replaced(text_of(scenarios() / "gto-nutating.toml"),
                                                 "half_angle_deg = 0.2", "half_angle_deg = 1.0"),
                                        "duration_s = 600.0", "duration_s = 150.0");
  const std::string healthy =
      replaced(spinner, "mount_angle_deg = 95.0", "mount_angle_deg = 95.0\nhealthy = true");
  const Window& whole = kWholePass;
  return {
      {"sun1 dead", silent("sun1"), spinner, dead(of({Sun1})), 15.0},
      {"sun2 dead", silent("sun2"), spinner, dead(of({Sun2})), 15.0},
      {"sun1 dead from the start", silent("sun1"), spinner, dead(of({Sun1})), 15.0, whole, false},
      {"north beam dead", silent("north_in"), spinner, dead(of({NorthIn, NorthOut})), 15.0},
      {"south beam dead", silent("south_in"), spinner, dead(of({SouthIn, SouthOut})), 15.0},
      {"north_out dead", silent("north_out"), spinner, dead(of({NorthOut})), 15.0},
      {"south beam dead from the start", silent("south_in"), healthy, dead(of({SouthIn, SouthOut})),
       120.0, whole, false},
      {"sun2 dead from the start", silent("sun2"), spinner, dead(of({Sun2})), 120.0, whole, false},
      {"no second axis",
       {"spin.ambiguous"},
       spinner,
       dead(of({Sun2, NorthIn, NorthOut})),
       120.0,
       whole,
       false},
      {"sun1 alone",
       {"spin.no_answer"},
       spinner,
       dead(of({Sun2, NorthIn, NorthOut, SouthIn, SouthOut})),
       70.0,
       whole,
       false},
      {"edges of two channels interfere", {"spin.interference"}, near_beams, interfere},
      {"wrong spin rate",
       {"spin.rate"},
       spinner,
       {},
       30.0,
       whole,
       false,
       target + "rpm = 56.0\ntolerance_rpm = 0.5\n"},
      {"axis off target by 5 deg",
       {"spin.off_target"},
       replaced(spinner, "dec_deg = -55.0", "dec_deg = -50.0"),
       {},
       30.0,
       whole,
       false,
       target},
      {"axis moves by 10 deg", {"attitude.lost"}, spinner, turned, 60.0, {}, true, target},
      {"axis moves by 10 deg: where it is then", {"spin.sigma"}, spinner, turned, 60.0},
      {"nutation of 1 deg", {"spin.nutation"}, nutating, {}, 70.0, whole, false},
      {"nutation of 1 deg: the answer", {"spin.doubtful"}, nutating, {}, 60.0, whole, false},
      {"noise of 20 ms on all channels",
       {"spin.rejection"},
       spinner,
       jittered(any_of_all, 0.02),
       60.0,
       minute},
      {.name = "every other edge of sun1 off by 2 ms",
       .keys = {"spin.period"},
       .scenario = spinner,
       .sensors = alternating(Sun1, 2e-3),
       .within_s = 60.0,
       .culprit = "sensor.contradicts:sun1"},
      // More is soon a contradiction between sensors, which makes all estimators doubtful.
      {.name = "sun2 turned by 0.1 deg: the estimators, by a narrow limit",
       .keys = {"spin.disagree"},
       .scenario = spinner,
       .sensors = moved(of({Sun2}), 0.1 / 330.0),
       .within_s = 120.0,
       .more_of_mission = "\n[alerts.\"spin.disagree\"]\nsigmas = 1.0\n",
       .culprit = "sensor.contradicts:sun2"}};
}

/// Every sensor is wrong in every way in which it may be.
inline std::vector<Fault> lies_of_a_spinner() {
  using enum PulseChannel;
  const std::string spinner = spinner_text();
  constexpr double kTwoDegrees_s = 2.0 / 330.0;
  constexpr std::int64_t kHundredth_ns = 10'000'000;
  const std::set<std::string> north{"sensor.contradicts:north_in", "sensor.contradicts:north_out"};
  const std::set<std::string> south{"sensor.contradicts:south_in", "sensor.contradicts:south_out"};
  const std::set<PulseChannel> north_beam{NorthIn, NorthOut};
  const std::set<PulseChannel> south_beam{SouthIn, SouthOut};
  struct Sensor {
    std::string name;
    std::set<std::string> keys;
    std::set<PulseChannel> channels;
  };
  std::vector<Fault> faults;
  for (const Sensor& sensor :
       {Sensor{"sun1", contradicts("sun1"), {Sun1}}, Sensor{"sun2", contradicts("sun2"), {Sun2}},
        Sensor{"north beam", north, north_beam}, Sensor{"south beam", south, south_beam}}) {
    const auto add_one = [&](const std::string& what, const Spoil& spoil, double within_s = 10.0) {
      faults.push_back({sensor.name + " " + what, sensor.keys, spinner, spoil, within_s});
    };
    const PulseChannel first = *sensor.channels.begin();
    add_one("runs free", runs_free(sensor.channels, 0.013));
    add_one("turned by 2 deg", moved(of(sensor.channels), kTwoDegrees_s));
    add_one("biased at one edge by 4 ms", moved(of({first}), 4e-3));
    add_one("noisy, 20 ms", jittered(of(sensor.channels), 0.02), 20.0);
    add_one("cut to 10 ms", cut(first, kHundredth_ns), 20.0);
    add_one("late by a second", late_by_a_second(of(sensor.channels)));
  }
  faults.push_back(
      // Both lie: no single sensor explains it.
      {"sun1 and sun2 swapped", contradicts("unknown"), spinner, swapped(Sun1, Sun2), 30.0});
  faults.push_back({"north_in and north_out swapped", north, spinner, swapped(NorthIn, NorthOut)});
  faults.push_back({"south_in and south_out swapped", south, spinner, swapped(SouthIn, SouthOut)});
  faults.push_back(
      {"orbit wrong by ten minutes",
       contradicts("orbit"),
       spinner,
       {},
       10.0,
       kWholePass,
       false,
       {},
       {},
       {},
       false,
       [spinner](Mission& mission) {
         mission.orbit =
             loaded(replaced(spinner, "mean_anomaly_deg = 30.0", "mean_anomaly_deg = 36.0")).orbit;
       }});
  return faults;
}

}  // namespace spindrift::testing
