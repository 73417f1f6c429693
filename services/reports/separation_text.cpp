#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "pipelines/time/utc.h"
#include "services/base/assessment_words.h"
#include "services/base/counted.h"
#include "services/base/decimals.h"
#include "services/base/degrees.h"
#include "services/reports/separation_report.h"

namespace spindrift {
namespace {

constexpr int kLeastDecimals = 3;

std::string_view words_of(SeparationEvent event) {
  static constexpr std::array<std::string_view, 4> kWords{"separation", "attitude control on",
                                                          "sun acquisition", "first star fix"};
  return kWords.at(static_cast<std::size_t>(event));
}

std::string used_of(const SensorResiduals& sensor, std::string_view plural) {
  return counted(sensor.count, plural) +
         (sensor.outliers > 0 ? fmt::format(" (and {} left out)", sensor.outliers) : "");
}

std::string events_text(const Reconstruction& solution) {
  std::string text;
  for (const ReconstructedEvent& event : solution.events) {
    text += fmt::format("  {:<13}{} {:<20} {}{}\n", text.empty() ? "events" : "",
                        name_of(event.event), words_of(event.event), format_utc(event.attitude.t),
                        event.found ? "  found in the samples" : "");
  }
  return text;
}

/// Calls `see(product, event, index of the event)` for each event, for all methods in turn.
template <class See>
void for_each_event(const SeparationReport& report, const See& see) {
  for (const auto name : {SeparationEvent::Separation, SeparationEvent::ControlOn,
                          SeparationEvent::Acquisition, SeparationEvent::FirstStarFix}) {
    for (const ReconstructionProduct& product : report.methods) {
      const auto& events = product->solution.events;
      for (std::size_t i = 0; i < events.size(); ++i) {
        if (events[i].event == name) {
          see(*product, events[i], i);
        }
      }
    }
  }
}

std::string row_of(const ReconstructedSeparation& separation, const ReconstructedEvent& event) {
  return fmt::format("               {} {:<11}", name_of(event.event),
                     name_of(separation.solution.method));
}

std::string angles_text(const Euler312Reading& reading, int decimals) {
  const Euler312& angles = reading.angles;
  return fmt::format("{0:>{4}.{5}f} {1:>{4}.{5}f} {2:>{4}.{5}f}{3}", angles.phi_rad * kDegPerRad,
                     angles.theta_rad * kDegPerRad, angles.psi_rad * kDegPerRad,
                     reading.near_singular ? "  near the singularity" : "", decimals + 6, decimals);
}

std::string angles_heading(std::string_view what, int decimals) {
  return fmt::format("  {:<25}  {:>{}} {:>{}} {:>{}}", what, "phi", decimals + 6, "theta",
                     decimals + 6, "psi", decimals + 6);
}

int decimals_of(const SeparationReport& report) {
  int decimals = kLeastDecimals;
  for_each_event(report, [&](const auto& /*separation*/, const ReconstructedEvent& event, auto) {
    decimals =
        std::max(decimals, decimals_for(event.attitude.sigma_rad() * kDegPerRad, kLeastDecimals));
  });
  return std::min(decimals, 5);
}

std::string icrf_text(const SeparationReport& report, int decimals) {
  std::string text =
      angles_heading("ICRF to body", decimals) +
      fmt::format(" {0:>{2}} {1:>{2}}   deg, Euler 3-1-2\n", "sigma", "bound", decimals + 5);
  for_each_event(report, [&](const auto& separation, const ReconstructedEvent& event, auto) {
    const auto bound =
        event.bound_rad ? fmt::format("{:.{}f}", *event.bound_rad * kDegPerRad, decimals) : "-";
    Euler312Reading reading = euler312_of(event.attitude.q_icrf_body);
    const bool near_singular = std::exchange(reading.near_singular, false);
    text +=
        row_of(separation, event) + angles_text(reading, decimals) +
        fmt::format(" {:>{}.{}f} {:>{}}{}\n", event.attitude.sigma_rad() * kDegPerRad, decimals + 5,
                    decimals, bound, decimals + 5, near_singular ? "  near the singularity" : "");
  });
  return text;
}

std::string quaternion_text(const SeparationReport& report) {
  std::string text = fmt::format("  {:<25}  {:>10} {:>10} {:>10} {:>10}   quaternion\n",
                                 "ICRF to body", "x", "y", "z", "w");
  for_each_event(report, [&](const auto& separation, const ReconstructedEvent& event, auto) {
    const Eigen::Quaterniond& q = event.attitude.q_icrf_body;
    text += row_of(separation, event) +
            fmt::format("{:>10.7f} {:>10.7f} {:>10.7f} {:>10.7f}\n", q.x(), q.y(), q.z(), q.w());
  });
  return text;
}

std::string orbit_text(const SeparationReport& report, int decimals) {
  if (report.methods.front()->in_orbit_frame.empty()) {
    return "  orbit frame  not known: the mission file names no orbit\n";
  }
  std::string text = angles_heading("orbit frame to body", decimals) + "   deg, Euler 3-1-2\n";
  for_each_event(report, [&](const ReconstructedSeparation& separation,
                             const ReconstructedEvent& event, std::size_t i) {
    const auto& reading = separation.in_orbit_frame.at(i);
    text += row_of(separation, event) +
            (reading ? angles_text(*reading, decimals) : "  " + reading.error().message) + "\n";
  });
  return text;
}

/// Formats angles in rad as degrees with their sigmas.
std::string axes_text(const Eigen::Vector3d& value, const Eigen::Matrix3d& covariance) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += fmt::format(
        "{}{} {}", axis == 0 ? "" : "  ", "xyz"[axis],
        signed_with_sigma(value[axis] * kDegPerRad, std::sqrt(covariance(axis, axis)) * kDegPerRad,
                          kLeastDecimals));
  }
  return text;
}

std::string misalignment_text(const Reconstruction& solution) {
  return solution.misalignment ? "  sun sensor   turned by " +
                                     axes_text(solution.misalignment->vector_rad,
                                               solution.misalignment->covariance_rad2) +
                                     " deg, body axes\n"
                               : "";
}

std::string bias_text(const Reconstruction& solution) {
  if (!solution.bias) {
    return {};
  }
  std::string text = "  gyro bias    " +
                     axes_text(solution.bias->rad_s, solution.bias->covariance_rad2_s2) +
                     " deg/s\n";
  for (const OpenBiasDirection& open : solution.open_bias) {
    const Eigen::Vector3d& axis = open.axis_body;
    text += fmt::format(
        "               open along ({:+.2f}, {:+.2f}, {:+.2f}) by {:.2g} deg/s, {:.0f} % of what "
        "was "
        "known beforehand{}\n",
        axis.x(), axis.y(), axis.z(), open.sigma_rad_s * kDegPerRad, 100.0 * open.share,
        open.off_sun_rad
            ? fmt::format(", {:.0f} deg off the Sun line", *open.off_sun_rad * kDegPerRad)
            : "");
  }
  return text;
}

std::string launcher_text(const SeparationReport& report) {
  std::string text;
  for (const ReconstructionProduct& product : report.methods) {
    if (const auto& check = product->launcher) {
      const auto name = name_of(product->solution.method);
      text += fmt::format("  {:<13}", text.empty() ? "launcher" : "");
      text += *check
                  ? fmt::format(
                        "{}: {:.3f} deg apart at T1, chi-square {:.2f} of 3 degrees of freedom: {} "
                        "{:.0f} %\n",
                        name, (*check)->difference.angle_rad * kDegPerRad,
                        (*check)->difference.chi_square,
                        (*check)->chance >= kLeastChance ? "inside" : "OUTSIDE",
                        100.0 * (1.0 - kLeastChance))
                  : fmt::format("not checked: {}\n", check->error().message);
    }
  }
  return text;
}

}  // namespace

std::string to_text(const SeparationReport& report) {
  const Reconstruction& first = report.methods.front()->solution;
  const int decimals = decimals_of(report);
  std::string text = fmt::format("{}  run {}\n", report.spacecraft_id, report.run_id);
  text += fmt::format("  rests on     {}, {}, {}\n", used_of(first.gyro, "gyro samples"),
                      used_of(first.sun, "sun vectors"), used_of(first.star, "star fixes"));
  text += events_text(first) + icrf_text(report, decimals) + quaternion_text(report) +
          orbit_text(report, decimals) + bias_text(first) + misalignment_text(first) +
          launcher_text(report);
  for (const ReconstructionProduct& product : report.methods) {
    text += fmt::format("  {:<13}{}\n", name_of(product->solution.method),
                        sentence_of(product->solution.assessment));
  }
  return text;
}

}  // namespace spindrift
