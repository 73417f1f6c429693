#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/frames/rotation_vector.h"
#include "services/base/degrees.h"
#include "services/reports/colours.h"
#include "services/reports/separation_report.h"
#include "services/reports/time_page.h"

namespace spindrift {
namespace {

using plot::Curve;
using plot::Mark;
using plot::TimePage;

constexpr std::string_view kPhi = plot::kBlue;
constexpr std::string_view kTheta = plot::kGreen;
constexpr std::string_view kPsi = plot::kVermilion;
constexpr std::string_view kFirst = plot::kBlue;
constexpr std::string_view kSecond = plot::kOrange;

using History = std::vector<ReconstructedAttitude>;

Eigen::Vector3d angles_deg(const Eigen::Quaterniond& q_icrf_body) {
  const auto [phi, theta, psi] = euler312_of(q_icrf_body).angles;
  return kDegPerRad * Eigen::Vector3d{phi, theta, psi};
}

/// Returns the standard deviations of phi, theta and psi in deg.
Eigen::Vector3d angle_sigmas_deg(const ReconstructedAttitude& attitude) {
  constexpr double kStep_rad = 1e-6;
  Eigen::Matrix3d slopes;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step_rad = kStep_rad * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d there = angles_deg(attitude.q_icrf_body * quaternion_by(step_rad));
    const Eigen::Vector3d back = angles_deg(attitude.q_icrf_body * quaternion_by(-step_rad));
    slopes.col(axis) = (there - back).unaryExpr([](double deg) {
      return std::remainder(deg, 360.0) / (2.0 * kStep_rad);
    });
  }
  return (slopes * attitude.covariance_rad2 * slopes.transpose())
      .diagonal()
      .cwiseSqrt()
      .cwiseMin(180.0);
}

/// Returns the curve of an angle with its band; a gap where it wraps to the other end of its range.
Curve angle_curve(const History& history, int angle, std::string name, std::string_view colour) {
  Curve curve{.name = std::move(name), .colour = colour, .values = {}, .half_widths = {}};
  std::optional<double> before_deg;
  for (const ReconstructedAttitude& attitude : history) {
    const double deg = angles_deg(attitude.q_icrf_body)[angle];
    const bool jumps = before_deg && std::abs(deg - *before_deg) > 180.0;
    curve.values.push_back(jumps ? std::nullopt : std::optional{deg});
    curve.half_widths.push_back(angle_sigmas_deg(attitude)[angle]);
    before_deg = deg;
  }
  return curve;
}

/// Returns an axis that covers the curves with their bands.
plot::ValueAxis angle_axis(std::string title, const std::vector<Curve>& curves) {
  double low = 180.0;
  double high = -180.0;
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
      if (const auto& deg = curve.values[i]) {
        low = std::min(low, *deg - curve.half_widths[i]);
        high = std::max(high, *deg + curve.half_widths[i]);
      }
    }
  }
  constexpr int kMostTicks = 9;
  // The margin at the top is for the names of the marks.
  const double tenth = 0.1 * std::max(1.0, high - low);
  low = std::max(-180.0, low - 0.5 * tenth);
  high += tenth;
  return {.title = std::move(title),
          .is_logarithmic = false,
          .low = low,
          .high = high,
          .ticks = plot::linear_ticks(low, std::min(180.0, high), kMostTicks)};
}

/// Returns at each time of `history` the value of the next point of `other`; a gap after its last.
template <class Value>
Curve curve_beside(const History& history, const History& other, std::string name,
                   std::string_view colour, const Value& value) {
  Curve curve{.name = std::move(name), .colour = colour, .values = {}};
  auto beside = other.begin();
  for (const ReconstructedAttitude& attitude : history) {
    while (beside != other.end() && beside->t < attitude.t) {
      ++beside;
    }
    const double deg = beside != other.end() ? value(attitude, *beside) * kDegPerRad : 0.0;
    curve.values.push_back(deg > 0.0 ? std::optional{deg} : std::nullopt);
  }
  return curve;
}

plot::ValueAxis decades_of(std::string title, const std::vector<Curve>& curves) {
  const auto [least, most] = range_of(curves, 1.0, 0.01);
  const double low = std::max(1e-4, std::pow(10.0, std::floor(std::log10(least))));
  const double high = std::pow(10.0, std::ceil(std::log10(most)));
  return plot::logarithmic_axis(std::move(title), low, high);
}

void add_errors(TimePage& page, const SeparationReport& report) {
  const History& first = report.methods.front()->solution.history;
  std::vector<Curve> curves;
  for (const ReconstructionProduct& product : report.methods) {
    curves.push_back(
        curve_beside(first, product->solution.history,
                     fmt::format("{}, 1 sigma", name_of(product->solution.method)),
                     curves.empty() ? kFirst : kSecond,
                     [](const auto& /*first*/, const auto& one) { return one.sigma_rad(); }));
    // Dashes let both curves be seen where they coincide.
    curves.back().dashes = curves.size() > 1 ? "8 4" : "";
  }
  // The scale does not depend on the difference between the methods.
  const plot::ValueAxis axis =
      decades_of("Uncertainty of the attitude, all three axes together, deg", curves);
  if (report.methods.size() > 1) {
    curves.push_back(curve_beside(first, report.methods.back()->solution.history,
                                  "the two apart by", plot::kGrey,
                                  [](const auto& one, const auto& other) {
                                    return angle_between_rad(one.q_icrf_body, other.q_icrf_body);
                                  }));
    curves.back().dashes = "4 3";
  }
  page.panel(200.0, axis, curves);
}

std::vector<Mark> marks_of(const Reconstruction& solution) {
  std::vector<Mark> marks;
  for (const ReconstructedEvent& event : solution.events) {
    marks.push_back({.t = event.attitude.t, .name = std::string{name_of(event.event)}});
  }
  return marks;
}

}  // namespace

std::string plot_of(const SeparationReport& report) {
  const Reconstruction& solution = report.methods.front()->solution;
  const History& history = solution.history;
  if (history.size() < 2) {
    return {};
  }
  std::vector<TaiTime> times;
  for (const ReconstructedAttitude& attitude : history) {
    times.push_back(attitude.t);
  }
  TimePage page{fmt::format("{}: attitude from separation to the star fix", report.spacecraft_id),
                fmt::format("{}: {}; T1 separation, T2 control on, T3 sun acquisition, T4 star fix",
                            name_of(solution.method), name_of(solution.assessment.quality)),
                std::move(times), marks_of(solution)};
  const std::vector<Curve> angles = {angle_curve(history, 0, "phi", kPhi),
                                     angle_curve(history, 1, "theta", kTheta),
                                     angle_curve(history, 2, "psi", kPsi)};
  page.panel(300.0,
             angle_axis(fmt::format("ICRF to body, Euler 3-1-2, deg; band, where it is wider than "
                                    "the line: 1 sigma of {}",
                                    name_of(solution.method)),
                        angles),
             angles);
  add_errors(page, report);
  return page.document({});
}

}  // namespace spindrift
