#include "pipelines/spin/fix/axis_candidates.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/beam_view.h"
#include "pipelines/spin/measurement/errors_of_alignment.h"
#include "pipelines/spin/measurement/uncertain.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

using Tangent = Eigen::Matrix<double, 2, kEdges + kModelErrors>;
using PerAlignment = Eigen::Matrix<double, 2, kSpinAlignmentErrors>;

tl::unexpected<NoCandidates> unobservable(WhyNoFix why) {
  return tl::unexpected{NoCandidates{.why = std::move(why)}};
}

/// Holds a value that should be zero, and its standard deviation by noise and alignment.
struct Contradiction {
  double value;
  double sigma;

  bool agrees() const { return std::abs(value) <= kContradictionSigmas * sigma + kModelLimit_rad; }
  /// Zero when the sigma is rounding only.
  double chi_square() const {
    constexpr double kRounding = 1e-12;
    return sigma > kRounding ? value * value / (sigma * sigma) : 0.0;
  }
};

/// Returns how errors of the mission file act on a place as model errors. Where slit 2 alone saw
/// the Sun, its separation is an azimuth.
ErrorsOfAlignment errors_at(const FixInput& input, const AxisAngles& place) {
  ErrorsOfAlignment errors =
      errors_of_alignment(input.config, {.sun_angle_rad = place.sun_angle_rad.value(),
                                         .earth_angle_rad = place.earth_angle_rad.value(),
                                         .disc_rad = input.sun_earth.disc_rad});
  if (input.mixed_azimuth && !input.sun_angle && !input.dihedral) {
    errors.col(SlitSeparationError) << 0.0, 0.0, 0.0, -1.0, -1.0;
  }
  return errors;
}

Eigen::Vector3d axis_of(const SunEarthDirections& sun_earth, const AxisAngles& place) {
  return axis_icrf(AxisInput<double>{.sun_icrf = sun_earth.sun_icrf,
                                     .earth_icrf = sun_earth.earth_icrf,
                                     .sun_angle_rad = place.sun_angle_rad.value(),
                                     .earth_angle_rad = place.earth_angle_rad.value(),
                                     .dihedral_rad = place.dihedral_rad.value()})
      .normalized();
}

/// Returns the motion of a root per second of the Earth's motion, with fixed angles and views.
Eigen::Vector3d moved_by_earth_icrf_s(const FixInput& input, const Eigen::Vector3d& root_icrf) {
  SunEarthDirections later = input.sun_earth;
  const Eigen::Vector3d& motion = later.earth_motion_icrf_s;
  later.disc_rad -= std::tan(later.disc_rad) * motion.dot(later.earth_icrf);
  later.earth_icrf = (later.earth_icrf + motion).normalized();
  Eigen::Vector3d nearest = root_icrf;
  double most = -1.0;
  for (const AxisAngles& place :
       solve_axis_angles(
           fix_input(input.config, input.measured, later,
                     views_of_horizon(input.config, input.measured, later, root_icrf)))
           .places) {
    const Eigen::Vector3d axis = axis_of(later, place);
    if (axis.dot(root_icrf) > most) {
      most = axis.dot(root_icrf);
      nearest = axis;
    }
  }
  return nearest - root_icrf;
}

/// Returns the disc that both chords show less that of the orbit; empty if they show none.
/// @param errors Model errors by the alignment, of unit variance.
std::optional<Contradiction> disc_contradiction(const FixInput& input, const AxisAngles& place,
                                                const ErrorsOfAlignment& errors) {
  const Uncertain cosine = cos_disc_seen(*input.north(), place.earth_angle_rad);
  if (!(std::abs(cosine.value()) < 1.0)) {
    return std::nullopt;
  }
  const Uncertain disc_rad = acos(cosine);
  const double off_rad = disc_rad.value() - place.beams.at(index_of(Side::North)).disc_rad;
  Eigen::Matrix<double, kModelErrors, 1> by_errors = disc_rad.derivatives().tail<kModelErrors>();
  by_errors[NorthLimb] -= 1.0;
  return Contradiction{
      .value = off_rad,
      .sigma = std::hypot(noise_of(disc_rad), (by_errors.transpose() * errors).norm())};
}

/// Returns the motion of the solution per motion of the axis from which its beams see the horizon,
/// both in the tangent plane. A view with the limb farther out or the chord's middle earlier acts
/// like a model error of limb or azimuth.
/// @param tangent Motion of the solution per error source, with fixed views.
Eigen::Matrix2d moved_by_views(const BeamViews& beams, const Eigen::Matrix<double, 3, 2>& basis,
                               const Tangent& tangent) {
  const auto& [north, south] = beams;
  const auto by = [&](ModelError error, const Eigen::Vector3d& per_step_icrf) -> Eigen::Matrix2d {
    return tangent.col(kEdges + error) * (per_step_icrf.transpose() * basis);
  };
  return by(NorthLimb, north.disc_per_step_icrf) + by(SouthLimb, south.disc_per_step_icrf) +
         by(NorthAzimuth, north.lead_per_step_icrf) + by(SouthAzimuth, south.lead_per_step_icrf);
}

AxisCandidate candidate_at(const FixInput& input, const AxisAngles& place) {
  const Eigen::Matrix<Uncertain, 3, 1> axis =
      axis_icrf(AxisInput<Uncertain>{.sun_icrf = input.sun_earth.sun_icrf,
                                     .earth_icrf = input.sun_earth.earth_icrf,
                                     .sun_angle_rad = place.sun_angle_rad,
                                     .earth_angle_rad = place.earth_angle_rad,
                                     .dihedral_rad = place.dihedral_rad});
  Eigen::Vector3d solved;
  Eigen::Matrix<double, 3, kEdges + kModelErrors> shifts;
  for (Eigen::Index i = 0; i < 3; ++i) {
    solved[i] = axis[i].value();
    shifts.row(i) = axis[i].derivatives();
  }
  const double norm = solved.norm();
  const Eigen::Vector3d unit = solved / norm;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(unit);
  Tangent tangent = basis.transpose() * shifts / norm;
  // Another axis sees another limb, which moves the axis again: a geometric series.
  const Eigen::PartialPivLU<Eigen::Matrix2d> views{Eigen::Matrix2d::Identity() -
                                                   moved_by_views(place.beams, basis, tangent)};
  tangent = views.solve(tangent).eval();
  const auto noise = tangent.leftCols<kEdges>();
  const SpinAlignment& alignment = input.config.alignment;
  const SpinAlignment root = root_of(alignment);
  const ErrorsOfAlignment errors = errors_at(input, place);
  PerAlignment by_alignment = -tangent.rightCols<kModelErrors>() * errors;
  if (alignment(TimeTagError, TimeTagError) > 0.0) {
    by_alignment.col(TimeTagError) -=
        views.solve(basis.transpose() * moved_by_earth_icrf_s(input, unit));
  }
  by_alignment *= root;
  const Eigen::RowVector3d along = unit.transpose();
  const Contradiction length{
      .value = norm - 1.0,
      .sigma = std::hypot((along * shifts.leftCols<kEdges>()).norm(),
                          (along * shifts.rightCols<kModelErrors>() * errors * root).norm())};
  const auto disc =
      input.both_chords() ? disc_contradiction(input, place, errors * root) : std::nullopt;
  return {.axis_icrf = unit,
          .covariance_rad2 = noise * noise.transpose(),
          .alignment_rad2 = by_alignment * by_alignment.transpose(),
          .norm = norm,
          .consistent = length.agrees() && (!input.both_chords() || (disc && disc->agrees())),
          .misfit = length.chi_square() + (disc ? disc->chi_square() : 0.0),
          .model_shift_icrf = basis * tangent.rightCols<kModelErrors>(),
          .alignment_shift_icrf = basis * by_alignment};
}

NoFixCode cone_code(int geometry_case) {
  switch (geometry_case) {
    case 8:
      return NoFixCode::BothChordsAlone;
    case 9:
      return NoFixCode::SunAngleAlone;
    case 10:
      return NoFixCode::OneChordAlone;
    default:
      return NoFixCode::NothingMeasured;
  }
}

/// Near a double root, or in an undetermined direction, the linear covariance has no meaning.
bool determined(const AxisCandidate& candidate) {
  return candidate.covariance_rad2.trace() < kLeastDetermined_rad * kLeastDetermined_rad;
}

// Each step is at most a tenth of the last; a slower root is about to vanish.
constexpr int kMostSteps = 10;
constexpr double kAtRest_rad = 1e-8;

/// Returns the root that `place` converges to, or no root if it vanishes.
AxisSolutions follow(const FixInput& on_sphere, const AxisAngles& place) {
  const SunEarthDirections& sun_earth = on_sphere.sun_earth;
  Eigen::Vector3d axis_icrf = axis_of(sun_earth, place);
  const auto off_rad = [&](const AxisAngles& other) {
    return angle_between_rad(axis_of(sun_earth, other), axis_icrf);
  };
  AxisSolutions found;
  for (int step = 0; step < kMostSteps; ++step) {
    found = solve_axis_angles(
        fix_input(on_sphere.config, on_sphere.measured, sun_earth,
                  views_of_horizon(on_sphere.config, on_sphere.measured, sun_earth, axis_icrf)));
    if (found.places.empty()) {
      return found;
    }
    const AxisAngles nearest = *std::min_element(
        found.places.begin(), found.places.end(),
        [&](const AxisAngles& a, const AxisAngles& b) { return off_rad(a) < off_rad(b); });
    found.places = {nearest};
    const double moved_rad = off_rad(nearest);
    if (moved_rad < kAtRest_rad) {
      return found;
    }
    axis_icrf = axis_of(sun_earth, nearest);
  }
  found.near_tangent = true;
  return found;
}

bool is_among(const std::vector<AxisAngles>& places, const AxisAngles& place,
              const SunEarthDirections& sun_earth) {
  const Eigen::Vector3d axis_icrf = axis_of(sun_earth, place);
  return std::any_of(places.begin(), places.end(), [&](const AxisAngles& other) {
    // Roots closer than this are the same.
    return angle_between_rad(axis_of(sun_earth, other), axis_icrf) < 1e-6;
  });
}

}  // namespace

AxisSolutions solve_on_horizon(const FixInput& on_sphere) {
  AxisSolutions first = solve_axis_angles(on_sphere);
  if (first.places.empty()) {
    return first;
  }
  AxisSolutions found;
  for (const AxisAngles& place : first.places) {
    AxisSolutions there = follow(on_sphere, place);
    found.near_tangent = found.near_tangent || there.near_tangent;
    found.reason = std::move(there.reason);
    if (!there.places.empty() &&
        !is_among(found.places, there.places.front(), on_sphere.sun_earth)) {
      found.places.push_back(there.places.front());
    }
  }
  rank(on_sphere, found);
  return found;
}

int geometry_case_of(const RevolutionMeasurements& measured) {
  using enum SpinQuantity;
  const auto has = [&](SpinQuantity quantity) {
    return good_value_of(measured, quantity).has_value();
  };
  const bool north = has(NorthChord);
  const bool south = has(SouthChord);
  // The cases are ordered by both chords, north only, south only.
  const int which = north && south ? 0 : (north ? 1 : 2);
  if (!north && !south) {
    return has(SunAngle) ? 9 : 0;
  }
  if (has(SunAngle)) {
    return 1 + which;
  }
  if (has(NorthDihedral) || has(SouthDihedral)) {
    return 4 + which;
  }
  if (has(MixedAzimuth)) {
    return which == 0 ? 7 : 4 + which;
  }
  return which == 0 ? 8 : 10;
}

bool is_inconsistent(const FoundCandidates& found) {
  if (!found) {
    return found.error().contradictory;
  }
  return std::none_of(found->candidates.begin(), found->candidates.end(),
                      [](const AxisCandidate& candidate) { return candidate.consistent; });
}

FoundCandidates axis_candidates(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const SunEarthDirections& sun_earth) {
  AxisCandidates result{.geometry_case = geometry_case_of(measured),
                        .candidates = {},
                        .told_apart = false,
                        .near_tangent = false};
  if (result.geometry_case < 1 || result.geometry_case > 7) {
    return unobservable({cone_code(result.geometry_case)});
  }
  const FixInput input = fix_input(config, measured, sun_earth, views_of_sphere(sun_earth));
  if (in_line(input.sun_earth_rad)) {
    return unobservable(
        {NoFixCode::SunEarthInLine, {{"sun_earth_deg", degrees(input.sun_earth_rad)}}});
  }
  const AxisSolutions found = solve_on_horizon(input);
  if (found.places.empty()) {
    return tl::unexpected{
        NoCandidates{.why = found.reason.value(), .contradictory = !found.near_tangent}};
  }
  for (const AxisAngles& place : found.places) {
    result.candidates.push_back(candidate_at(input, place));
    if (!determined(result.candidates.back())) {
      return unobservable({NoFixCode::LostInNoise});
    }
  }
  result.told_apart = found.told_apart;
  result.near_tangent = found.near_tangent;
  if (!input.both_chords() && result.geometry_case % 3 == 1) {
    ++result.geometry_case;  // Of two beams mounted alike only north's chord is used.
  }
  return result;
}

}  // namespace spindrift
