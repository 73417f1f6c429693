/// @file
/// A fault of a sensor, of the link or of the service, and what supervision must say of it.

#pragma once

#include <functional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/property/alerts/supervised_pass.h"

namespace spindrift::testing {

/// Span of a fault in seconds since the first sample.
struct Window {
  double from_s = 200.0;
  double until_s = 400.0;

  bool has(double t_s) const { return t_s >= from_s && t_s < until_s; }
};

/// Spoils the samples of a window. The samples are numbered behind it, but not behind that of
/// `Fault::link`.
using Spoil = std::function<void(std::vector<Sent>&, const Window&)>;

struct Fault {
  std::string name;
  std::set<std::string> keys;  ///< Alert keys, any of which reports the fault.
  std::string scenario;
  Spoil sensors = {};
  double within_s = 10.0;  ///< Longest time from the fault's begin to its alert.
  Window window = {};
  bool ends = true;  ///< Whether the fault's end must clear the alert.
  std::string more_of_mission = {};
  Spoil link = {};
  /// Changes the state of the service; receives the seconds since its begin.
  std::function<void(ServiceState&, double, const Window&)> service = {};
  bool is_separation = false;                  ///< Whether the separation is to be reconstructed.
  std::function<void(Mission&)> mission = {};  ///< Changes what the service knows.
  /// Alert key of the wrong sensor, which may be named beside where `keys` are of another alert.
  std::string culprit = {};
};

/// The whole pass, for what is wrong from its begin to its end.
inline constexpr Window kWholePass{.from_s = 0.0, .until_s = 1e6};

inline double time_in_s(const Sent& one, const std::vector<Sent>& all) {
  return seconds_between(all.front().came, one.came);
}

inline void sort(std::vector<Sent>& sent) {
  std::stable_sort(sent.begin(), sent.end(),
                   [](const Sent& a, const Sent& b) { return a.came < b.came; });
}

template <class Value>
Value* value_in(Sent& one) {
  auto* const sample = std::get_if<TelemetrySample<Value>>(&one.sample);
  return sample == nullptr ? nullptr : &sample->value;
}

/// Returns whether a sample is of a sensor.
using IsOf = std::function<bool(const Sent&)>;

template <class Value>
bool is_of(const Sent& one) {
  return std::holds_alternative<TelemetrySample<Value>>(one.sample);
}

inline IsOf of(std::set<PulseChannel> channels) {
  return [channels](const Sent& one) {
    const auto* const pulse = std::get_if<TelemetrySample<Pulse>>(&one.sample);
    return pulse != nullptr && channels.contains(pulse->value.channel);
  };
}

inline bool any_of_all(const Sent& /*one*/) { return true; }

inline Spoil dead(IsOf is_of_it) {
  return [=](std::vector<Sent>& sent, const Window& window) {
    const TaiTime start = sent.front().came;
    std::erase_if(sent, [&](const Sent& one) {
      return window.has(seconds_between(start, one.came)) && is_of_it(one);
    });
  };
}

/// @param change Receives the value and the seconds since the fault.
template <class Value>
Spoil changed(std::function<void(Value&, double)> change) {
  return [=](std::vector<Sent>& sent, const Window& window) {
    auto changes = change;  // Each row has a state of its own.
    for (Sent& one : sent) {
      const double t_s = time_in_s(one, sent);
      Value* const value = value_in<Value>(one);
      if (value != nullptr && window.has(t_s)) {
        changes(*value, t_s - window.from_s);
      }
    }
  };
}

/// The sensor repeats what it said first.
template <class Value>
Spoil stuck() {
  std::optional<Value> first;
  return changed<Value>([first](Value& value, double /*t_s*/) mutable {
    const TaiTime t = value.t;
    first = value = first.value_or(value);
    value.t = t;
  });
}

/// Moves the times of samples, and their arrival with them.
/// @param off_s Receives the seconds since the fault.
inline Spoil moved(IsOf is_of_it, std::function<double(double)> off_s) {
  return [=](std::vector<Sent>& sent, const Window& window) {
    const TaiTime start = sent.front().came;
    auto off = off_s;
    for (Sent& one : sent) {
      const double t_s = seconds_between(start, one.came);
      if (window.has(t_s) && is_of_it(one)) {
        one.came = time_of(one.sample) = shifted(time_of(one.sample), off(t_s - window.from_s));
      }
    }
    sort(sent);
  };
}

inline Spoil moved(IsOf is_of_it, double off_s) {
  return moved(std::move(is_of_it), [off_s](double /*t_s*/) { return off_s; });
}

inline Spoil jittered(IsOf is_of_it, double sigma_s) {
  return moved(std::move(is_of_it), [rng = std::mt19937_64{2303},
                                     noise_s = std::normal_distribution<double>{0.0, sigma_s}](
                                        double /*t_s*/) mutable { return noise_s(rng); });
}

inline Spoil late_by_a_second(IsOf is_of_it) {
  return [=](std::vector<Sent>& sent, const Window& window) {
    dead(is_of_it)(sent, {.from_s = window.until_s, .until_s = window.until_s + 1.0});
    moved(is_of_it, 1.0)(sent, window);
  };
}

inline std::set<std::string> silent(const std::string& channel) {
  return {"channel.silent:" + channel};
}

inline std::set<std::string> contradicts(const std::string& culprit) {
  return {"sensor.contradicts:" + culprit};
}

inline Flight spoilt(const Fault& fault) {
  Flight flight = flown(fault.scenario, fault.more_of_mission);
  if (!fault.is_separation) {
    flight.mission.separation.reset();
  }
  if (fault.mission) {
    fault.mission(flight.mission);
  }
  if (fault.sensors) {
    fault.sensors(flight.sent, fault.window);
  }
  number(flight.sent);
  if (fault.link) {
    fault.link(flight.sent, fault.window);
  }
  return flight;
}

}  // namespace spindrift::testing
