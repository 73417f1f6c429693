#include "services/simulation/flight_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "services/base/degrees.h"
#include "services/reports/colours.h"
#include "services/reports/time_page.h"

namespace spindrift {
namespace {

using plot::Curve;
using plot::curve_of;
using plot::TimePage;

// More points than there are pixels.
constexpr std::size_t kMostPoints = 1000;

/// Returns the times of the plotted points since the start.
std::vector<double> times_s(const SimulatedPass& pass) {
  const double end_s = pass.motion->end_s();
  std::vector<double> times;
  for (std::size_t i = 0; i <= kMostPoints; ++i) {
    times.push_back(end_s * static_cast<double>(i) / static_cast<double>(kMostPoints));
  }
  return times;
}

/// Returns an axis that covers all values with a margin, and at least +-`least`.
plot::ValueAxis axis_of(std::string title, const std::vector<Curve>& curves, double least) {
  const auto [low, high] = range_of(curves, -least, least);
  const double room = 0.05 * (high - low);
  return plot::linear_axis(std::move(title), low - room, high + room, 5);
}

void add_panel(TimePage& page, std::string title, const std::vector<Curve>& curves, double least) {
  constexpr double kHeight = 140.0;
  page.panel(kHeight, axis_of(std::move(title), curves, least), curves);
}

/// Returns the attitudes relative to the start, with signs chosen so that they are continuous.
std::vector<Eigen::Quaterniond> attitudes(const BodyMotion& motion,
                                          const std::vector<double>& times) {
  const Eigen::Quaterniond q_start_icrf = motion.at(0.0).q_icrf_body.conjugate();
  std::vector<Eigen::Quaterniond> all;
  for (const double t_s : times) {
    Eigen::Quaterniond q = q_start_icrf * motion.at(t_s).q_icrf_body;
    if (!all.empty() && q.dot(all.back()) < 0.0) {
      q.coeffs() = -q.coeffs();
    }
    all.push_back(q);
  }
  return all;
}

void add_attitude(TimePage& page, const BodyMotion& motion, const std::vector<double>& times) {
  constexpr std::array<std::pair<std::string_view, int>, 4> kElements = {
      {{"w", 3}, {"x", 0}, {"y", 1}, {"z", 2}}};
  const std::vector<Eigen::Quaterniond> all = attitudes(motion, times);
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < kElements.size(); ++i) {
    const auto& [name, element] = kElements.at(i);
    curves.push_back(
        curve_of(std::string{name}, i == 0 ? plot::kInk : plot::kCurves.at(i - 1), all,
                 [&, at = element](const Eigen::Quaterniond& q) { return q.coeffs()[at]; }));
  }
  add_panel(page, "Attitude seen from the start, quaternion", curves, 1.0);
}

void add_rates(TimePage& page, const BodyMotion& motion, const std::vector<double>& times) {
  std::vector<Curve> curves;
  curves.reserve(3);
  for (int i = 0; i < 3; ++i) {
    curves.push_back(
        curve_of(std::string(1, "xyz"[i]), plot::kCurves.at(static_cast<std::size_t>(i)), times,
                 [&](double t_s) { return kDegPerRad * motion.at(t_s).rate_body_rad_s[i]; }));
  }
  add_panel(page, "Body rates, deg/s", curves, 0.1);
}

const ControlRecord& record_at(const std::vector<ControlRecord>& record, double t_s) {
  const auto next = std::upper_bound(
      record.begin(), record.end(), t_s,
      [](double instant_s, const ControlRecord& each) { return instant_s < each.t_s; });
  return next == record.begin() ? record.front() : *std::prev(next);
}

void add_wheels(TimePage& page, const std::vector<ControlRecord>& record,
                const std::vector<double>& times) {
  const Eigen::Index wheels = record.front().momenta_nms.size();
  const auto name_of = [](Eigen::Index i) { return fmt::format("wheel {}", i + 1); };
  const auto colour_of = [](Eigen::Index i) {
    return plot::kCurves.at(static_cast<std::size_t>(i));
  };
  std::vector<Curve> momenta;
  for (Eigen::Index i = 0; i < wheels; ++i) {
    momenta.push_back(curve_of(name_of(i), colour_of(i), times,
                               [&](double t_s) { return record_at(record, t_s).momenta_nms[i]; }));
  }
  add_panel(page, "Momenta of the wheels, N m s", momenta, 0.01);
  for (Eigen::Index i = 0; i < wheels; ++i) {
    Curve is = curve_of("is", colour_of(i), times, [&](double t_s) {
      return kRpmPerRad_s * record_at(record, t_s).speeds_rad_s[i];
    });
    Curve told = curve_of("told", plot::kInk, times, [&](double t_s) {
      return kRpmPerRad_s * record_at(record, t_s).told_rad_s[i];
    });
    told.dashes = "4 6";
    add_panel(page, fmt::format("Speed of {}, rpm", name_of(i)), {is, told}, 100.0);
  }
}

/// Shows no error where none was computed within ten seconds, as in the shadow of the Earth.
void add_on_board(TimePage& page, const std::vector<OnBoardError>& errors,
                  const std::vector<double>& times) {
  constexpr double kGap_s = 10.0;
  const auto curve = [&](std::string name, std::string_view colour,
                         double OnBoardError::*error_rad) {
    return curve_of(std::move(name), colour, times, [&](double t_s) -> std::optional<double> {
      const auto next = std::lower_bound(
          errors.begin(), errors.end(), t_s,
          [](const OnBoardError& each, double instant_s) { return each.t_s < instant_s; });
      if (next == errors.end() || next->t_s > t_s + kGap_s) {
        return std::nullopt;
      }
      return kDegPerRad * (*next).*error_rad;
    });
  };
  add_panel(page, "Error of the attitude computed on board, deg",
            {curve("whole", plot::kBlue, &OnBoardError::with_table_rad),
             curve("the table's share", plot::kInk, &OnBoardError::by_table_rad)},
            0.1);
}

std::vector<plot::Mark> marks_of(const Scenario& scenario, const SimulatedPass& pass) {
  std::vector<plot::Mark> marks;
  const auto add = [&](double t_s, const char* name) {
    marks.push_back({shifted(scenario.start, t_s), name});
  };
  if (const auto* const flight = std::get_if<OrientationScenario>(&scenario.flight)) {
    add(flight->truth.control.plan.control_on_s, "damping");
    for (const auto& [key, name] :
         {std::pair{"pointing_s", "pointing"}, std::pair{"settled_s", "within 1 deg"}}) {
      if (pass.truth[key].is_number()) {
        add(pass.truth[key], name);
      }
    }
  } else if (std::holds_alternative<RescueScenario>(scenario.flight)) {
    for (const auto& [key, name] : {std::pair{"lost_s", "lost"}, std::pair{"control_s", "control"},
                                    std::pair{"reached_s", "reached"}}) {
      if (pass.truth[key].is_number()) {
        add(pass.truth[key], name);
      }
    }
  } else if (const auto* const separation = std::get_if<SeparationScenario>(&scenario.flight)) {
    add(separation->truth.control_on_s, "T2");
    add(separation->truth.acquisition_s, "T3");
    add(separation->first_star_fix_s, "T4");
  }
  std::erase_if(marks, [&](const plot::Mark& mark) {
    return mark.t > shifted(scenario.start, pass.motion->end_s());
  });
  return marks;
}

}  // namespace

std::string flight_plot(const Scenario& scenario, const SimulatedPass& pass) {
  const std::vector<double> seconds = times_s(pass);
  std::vector<TaiTime> times;
  times.reserve(seconds.size());
  for (const double t_s : seconds) {
    times.push_back(shifted(scenario.start, t_s));
  }
  TimePage page{scenario.spacecraft_id + ": how it turned", "the truth of a simulated pass",
                std::move(times), marks_of(scenario, pass)};
  add_attitude(page, *pass.motion, seconds);
  add_rates(page, *pass.motion, seconds);
  if (!pass.control.empty()) {
    add_wheels(page, pass.control, seconds);
  }
  if (pass.on_board) {
    add_on_board(page, pass.on_board->errors, seconds);
  }
  return page.document({});
}

}  // namespace spindrift
