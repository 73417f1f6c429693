#include "pipelines/spin/fix.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {
namespace {

// Within this angle of one line, Sun and Earth leave the axis free to turn about it.
constexpr double kInLine_rad = 3.0 * std::numbers::pi / 180.0;

// What measurements may contradict each other by: this many sigmas of their noise, and what the
// model leaves out (oblateness 0.2 deg, height and brightness of the CO2 layer likewise).
constexpr double kContradictionSigmas = 5.0;
constexpr double kModel_rad = 0.5 * std::numbers::pi / 180.0;

Unexpected unobservable(std::string message) {
  return Unexpected{{ErrorCode::Unobservable, std::move(message)}};
}

std::optional<Chord> chord_of(const SpinConfig& config, const RevolutionMeasurements& measured,
                              Side side) {
  const auto& crossing = measured.crossing(side);
  const auto& sensor = sensor_of(config, side);
  if (!crossing || !crossing->chord || !sensor) {
    return std::nullopt;
  }
  return Chord{.mount_angle_rad = sensor->mount_angle_rad, .chord_rad = crossing->chord->value_rad};
}

/// Both sensors measure the same dihedral: their mean, round the circle.
std::optional<double> dihedral_of(const RevolutionMeasurements& measured) {
  const auto north = value_of(measured, SpinQuantity::NorthDihedral);
  const auto south = value_of(measured, SpinQuantity::SouthDihedral);
  if (north && south) {
    return wrapped_rad(north->value_rad + 0.5 * wrapped_rad(south->value_rad - north->value_rad));
  }
  if (north || south) {
    return (north ? north : south)->value_rad;
  }
  return std::nullopt;
}

/// The candidates for theta_e, best first, and how they were told apart.
struct EarthAngles {
  std::vector<double> candidates_rad;
  Resolution resolution;
};

Expected<EarthAngles> earth_angle_from_one_chord(const SpinGeometry& limits,
                                                 const OneChordInput& input) {
  const double delta = std::abs(determinant(input));
  if (delta >= limits.determinant_usable) {
    const double earth_angle_rad = earth_angle_linear(input);
    if (!(earth_angle_rad > 0.0 && earth_angle_rad < std::numbers::pi)) {
      return unobservable(
          "the measured sun angle, chord and dihedral contradict each other: no "
          "earth angle in (0, 180) deg fits them");
    }
    return EarthAngles{.candidates_rad = {earth_angle_rad}, .resolution = Resolution::Geometry};
  }
  auto roots = earth_angle_roots(input);
  if (!roots) {
    return Unexpected{roots.error()};
  }
  const bool told_apart = roots->size() == 1 || delta > limits.determinant_ambiguous;
  return EarthAngles{.candidates_rad = std::move(*roots),
                     .resolution = told_apart ? Resolution::Geometry : Resolution::Ambiguous};
}

Eigen::Vector3d nearer(const AxisSolution& solution, const Eigen::Vector3d& axis_icrf) {
  const auto& alternate = solution.alternate_axis_icrf;
  const bool keeps = !alternate || solution.axis_icrf.dot(axis_icrf) >= alternate->dot(axis_icrf);
  return keeps ? solution.axis_icrf : *alternate;
}

RevolutionMeasurements measure_without(const SpinConfig& config, const Revolution& revolution,
                                       const std::set<SpinQuantity>& left_out) {
  RevolutionMeasurements measured = measure(config, revolution);
  for (const SpinQuantity quantity : left_out) {
    remove(measured, quantity);
  }
  return measured;
}

bool is_sun(std::size_t channel) {
  return channel == index_of(PulseChannel::Sun1) || channel == index_of(PulseChannel::Sun2);
}

}  // namespace

Expected<AxisSolution> solve_axis(const SpinConfig& config, const RevolutionMeasurements& measured,
                                  const Sightlines& sightlines) {
  const auto north = chord_of(config, measured, Side::North);
  const auto south = chord_of(config, measured, Side::South);
  const auto dihedral_rad = dihedral_of(measured);
  if (!measured.sun_angle || !dihedral_rad || (!north && !south)) {
    return unobservable("sun angle, a chord and a dihedral are needed for a fix");
  }
  const double sun_earth_rad = angle_between_rad(sightlines.sun_icrf, sightlines.earth_icrf);
  if (!(sun_earth_rad > kInLine_rad && sun_earth_rad < std::numbers::pi - kInLine_rad)) {
    return unobservable(
        fmt::format("Sun and Earth stand {:.3f} deg apart: the axis needs between "
                    "3 and 177 deg",
                    sun_earth_rad * 180.0 / std::numbers::pi));
  }

  EarthAngles earth{.candidates_rad = {}, .resolution = Resolution::Geometry};
  const auto from_both = north && south ? earth_angle_from_two_chords(*north, *south)
                                        : Expected<double>{unobservable("one chord only")};
  double disc_excess_rad = 0.0;
  if (from_both) {
    earth.candidates_rad = {*from_both};
    disc_excess_rad = disc_seen_rad(*north, *from_both) - sightlines.disc_rad;
  } else {
    auto found =
        earth_angle_from_one_chord(config.geometry, {.chord = north ? *north : *south,
                                                     .sun_angle_rad = measured.sun_angle->value_rad,
                                                     .dihedral_rad = *dihedral_rad,
                                                     .sun_earth_rad = sun_earth_rad,
                                                     .disc_rad = sightlines.disc_rad});
    if (!found) {
      return Unexpected{found.error()};
    }
    earth = std::move(*found);
  }

  const auto axis_for = [&](double earth_angle_rad) {
    return axis_icrf({.sun_icrf = sightlines.sun_icrf,
                      .earth_icrf = sightlines.earth_icrf,
                      .sun_angle_rad = measured.sun_angle->value_rad,
                      .earth_angle_rad = earth_angle_rad,
                      .dihedral_rad = *dihedral_rad});
  };
  const Eigen::Vector3d axis = axis_for(earth.candidates_rad.front());
  AxisSolution solution{.geometry_case = from_both ? 1 : (north ? 2 : 3),
                        .axis_icrf = axis.normalized(),
                        .alternate_axis_icrf = {},
                        .resolution = earth.resolution,
                        .norm = axis.norm(),
                        .contradiction = {axis.norm() - 1.0, disc_excess_rad}};
  if (earth.candidates_rad.size() > 1) {
    solution.alternate_axis_icrf = axis_for(earth.candidates_rad.back()).normalized();
  }
  return solution;
}

Expected<SpinFix> fix(const SpinConfig& config, const Revolution& revolution,
                      const std::set<SpinQuantity>& left_out, const Sightlines& sightlines) {
  const RevolutionMeasurements measured = measure_without(config, revolution, left_out);
  const auto solution = solve_axis(config, measured, sightlines);
  if (!solution) {
    return Unexpected{solution.error()};
  }

  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(solution->axis_icrf);
  Eigen::Matrix2d covariance_rad2 = Eigen::Matrix2d::Zero();
  Eigen::Array2d contradiction_variance = Eigen::Array2d::Zero();
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    if (!revolution.edges.at(channel)) {
      continue;
    }
    const double sigma_s = is_sun(channel) ? config.noise.sun_s : config.noise.infrared_s;
    const auto axis_with_edge_off_by = [&](double offset_s) {
      Revolution moved = revolution;
      moved.edges.at(channel) = shifted(*revolution.edges.at(channel), offset_s);
      return solve_axis(config, measure_without(config, moved, left_out), sightlines);
    };
    const auto later = axis_with_edge_off_by(sigma_s);
    const auto earlier = axis_with_edge_off_by(-sigma_s);
    if (!later || !earlier) {
      return unobservable(fmt::format("the solution exists only within one sigma of its edges: {}",
                                      (later ? earlier : later).error().message));
    }
    const Eigen::Vector2d moved_rad =
        0.5 * basis.transpose() *
        (nearer(*later, solution->axis_icrf) - nearer(*earlier, solution->axis_icrf));
    covariance_rad2 += moved_rad * moved_rad.transpose();
    contradiction_variance +=
        (0.5 * (later->contradiction - earlier->contradiction)).array().square();
  }
  const bool consistent = (solution->contradiction.array().abs() <=
                           kContradictionSigmas * contradiction_variance.sqrt() + kModel_rad)
                              .all();

  std::vector<Eigen::Vector3d> alternates;
  if (solution->alternate_axis_icrf) {
    alternates.push_back(*solution->alternate_axis_icrf);
  }
  return SpinFix{.revolution = revolution.number,
                 .t = *measured.t_sun1,
                 .geometry_case = solution->geometry_case,
                 .axis_icrf = solution->axis_icrf,
                 .covariance_rad2 = covariance_rad2,
                 .alternate_axes_icrf = std::move(alternates),
                 .resolution = solution->resolution,
                 .norm = solution->norm,
                 .accepted = consistent && solution->resolution != Resolution::Ambiguous};
}

}  // namespace spindrift
