/// @file
/// The table of faults of the link and of the service.

#pragma once

#include <algorithm>
#include <chrono>

#include "tests/property/alerts/fault.h"
#include "tests/property/alerts/three_axis_faults.h"

namespace spindrift::testing {

inline std::string nominal_text() { return text_of(scenarios() / "gto-nominal.toml"); }

/// Samples of the window come so much later, but none behind its end.
inline Spoil delayed(double by_s) {
  return [by_s](std::vector<Sent>& sent, const Window& window) {
    const TaiTime start = sent.front().came;
    const TaiTime until = shifted(start, window.until_s);
    for (Sent& one : sent) {
      if (window.has(seconds_between(start, one.came))) {
        one.came = std::min(shifted(one.came, by_s), until);
      }
    }
    sort(sent);
  };
}

inline void begin_session(Sent& one, std::uint64_t seq) {
  std::visit(
      [&](auto& sample) {
        sample.origin.session = 2;
        sample.origin.seq = seq;
      },
      one.sample);
}

/// The source begins a new session. @param repeated_s So much of the last one is sent again.
inline Spoil restarted(double repeated_s) {
  return [repeated_s](std::vector<Sent>& sent, const Window& window) {
    const TaiTime start = sent.front().came;
    const TaiTime from = shifted(start, window.from_s);
    std::vector<Sent> again;
    for (const Sent& one : sent) {
      if (one.came < from && seconds_between(one.came, from) <= repeated_s) {
        again.push_back(one);
        again.back().came = from;
      }
    }
    for (Sent& one : sent) {
      if (one.came >= from) {
        again.push_back(one);
      }
    }
    std::erase_if(sent, [&](const Sent& one) { return one.came >= from; });
    std::uint64_t seq = 0;
    for (Sent& one : again) {
      begin_session(one, seq++);
    }
    sent.insert(sent.end(), again.begin(), again.end());
  };
}

inline void lose_five(std::vector<Sent>& sent, const Window& window) {
  const auto first = std::find_if(
      sent.begin(), sent.end(), [&](const Sent& one) { return window.has(time_in_s(one, sent)); });
  sent.erase(first, first + 5);
}

/// Another source sends other fixes of the same instants.
inline void contradict(std::vector<Sent>& sent, const Window& window) {
  std::vector<Sent> more;
  for (const Sent& one : sent) {
    if (window.has(time_in_s(one, sent)) && is_of<StarFix>(one)) {
      more.push_back(one);
      value_in<StarFix>(more.back())->q_icrf_sensor *= turn(10.0, Eigen::Vector3d::UnitX());
      std::visit(
          [&](auto& sample) {
            sample.origin.source = "other";
            sample.origin.seq = more.size();
          },
          more.back().sample);
    }
  }
  sent.insert(sent.end(), more.begin(), more.end());
  sort(sent);
}

inline std::vector<Fault> service_faults() {
  const std::string spinner = nominal_text();
  const Window& whole = kWholePass;
  constexpr double kDay_s = 86400.0;
  using Change = std::function<void(ServiceState&)>;
  const auto of_service = [&](const std::string& name, const std::string& key,
                              const Change& change) {
    return Fault{.name = name,
                 .keys = {key},
                 .scenario = spinner,
                 .service = [change](ServiceState& state, double t_s, const Window& window) {
                   state.free_gib = 100.0;
                   state.data_ends = {{"orbit", {shifted(state.pass_t, 10.0 * kDay_s)}}};
                   if (window.has(t_s)) {
                     change(state);
                   }
                 }};
  };
  const auto rejected = [](ServiceState& state, double t_s, const Window& window) {
    state.received = static_cast<std::int64_t>(100.0 * t_s);
    state.rejected = static_cast<std::int64_t>(
        5.0 * (std::clamp(t_s, window.from_s, window.until_s) - window.from_s));
  };
  const auto stepped = [](ServiceState& state, double t_s, const Window& window) {
    state.clock_step_s = t_s == window.from_s + 1.0 ? 3.0 : 0.0;
  };
  const Window half_a_minute{.from_s = 200.0, .until_s = 230.0};
  const Window moment{.from_s = 200.0, .until_s = 202.0};
  return {
      {"nothing for half a minute",
       {"link.silent"},
       spinner,
       dead(any_of_all),
       10.0,
       half_a_minute},
      {"15 s late", {"link.late"}, spinner, {}, 20.0, {}, true, {}, delayed(15.0)},
      of_service("15 s ahead of the host", "link.ahead",
                 [](ServiceState& state) { state.late_s = -15.0; }),
      {"90 s late",
       {"link.late", "clock.disagree"},
       spinner,
       {},
       95.0,
       {},
       true,
       {},
       delayed(90.0)},
      {"five samples lost", {"link.gap:front-end"}, spinner, {}, 10.0, moment, true, {}, lose_five},
      {"one sample in twenty impossible",
       {"link.rejected"},
       spinner,
       {},
       30.0,
       {},
       true,
       {},
       {},
       rejected},
      {"source restarted",
       {"link.restarted:front-end"},
       spinner,
       {},
       10.0,
       moment,
       true,
       {},
       restarted(0.0)},
      {"last minute repeated",
       {"link.repeated:front-end"},
       spinner,
       {},
       10.0,
       moment,
       true,
       {},
       restarted(60.0)},
      {"two senders contradict each other",
       {"link.contradiction:front-end", "link.contradiction:other"},
       tumbling_text(),
       {},
       10.0,
       {},
       true,
       {},
       contradict},
      of_service("a second service", "service.twice",
                 [](ServiceState& state) { state.other_service = "spindrift gs2:4242"; }),
      of_service("a webhook takes no alerts", "alerts.undelivered",
                 [](ServiceState& state) { state.undelivered_s = 100.0; }),
      of_service("samples wait for the archive", "archive.backlog",
                 [](ServiceState& state) { state.backlog_s = 20.0; }),
      of_service("the archive does not write", "archive.write",
                 [](ServiceState& state) { state.write_failed = true; }),
      of_service("a reader holds the log", "archive.log",
                 [](ServiceState& state) { state.log_mib = 300.0; }),
      of_service("the disk is full", "archive.disk",
                 [](ServiceState& state) { state.free_gib = 0.5; }),
      {"the host's clock is stepped",
       {"clock.jump"},
       spinner,
       {},
       10.0,
       moment,
       true,
       {},
       {},
       stepped},
      of_service("the orbit ends", "data.outdated:orbit",
                 [](ServiceState& state) {
                   state.data_ends = {{"orbit", {shifted(state.pass_t, kDay_s / 24.0)}}};
                 }),
      {"flight is not the ground model's",
       {"model.departure:period"},
       replaced(spinner, "rate_rpm = 60.0", "rate_rpm = 61.0"),
       {},
       30.0,
       whole,
       false,
       "\n[ground_model]\nscenario = \"" + (scenarios() / "gto-nominal.toml").string() + "\"\n"},
      {"launcher wrong by 5 deg",
       {"reconstruction.launcher"},
       replaced(text_of(scenarios() / "separation.toml"), "sigma_deg = 0.5",
                "sigma_deg = 0.5\noff_deg = [5.0, 0.0, 0.0]"),
       {},
       600.0,
       whole,
       false,
       {},
       {},
       {},
       true}};
}

}  // namespace spindrift::testing
