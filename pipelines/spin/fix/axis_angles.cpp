#include "pipelines/spin/fix/axis_angles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/measurement/mixed_azimuth.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr double kNearTangentSigmas = 3.0;
// Sigmas of model errors, which are constant over the pass.
constexpr double kModelSigmas = 3.0;

/// Notes cones that touch within noise and model. If they miss each other by so little, the missing
/// roots may be the true ones.
/// @param excess Gap between the cones; negative where they cross.
void note_near_tangent(const Uncertain& excess, AxisSolutions& found) {
  const double noise_sigmas = excess.value() > 0.0 ? kContradictionSigmas : kNearTangentSigmas;
  const bool near_tangent =
      std::abs(excess.value()) <=
      std::hypot(noise_sigmas * noise_of(excess), kModelSigmas * model_uncertainty_of(excess));
  found.near_tangent = found.near_tangent || near_tangent;
}

/// Returns roots in (0, 180) deg and those that noise and model may have moved outside. Opposite to
/// the Sun, for example, the axis hardly depends on the dihedral and continues smoothly.
std::vector<Uncertain> possible_angles(const ConeRootsOf<Uncertain>& roots) {
  std::vector<Uncertain> angles_rad = roots.angles_rad;
  std::copy_if(roots.outside_rad.begin(), roots.outside_rad.end(), std::back_inserter(angles_rad),
               [](const Uncertain& root) {
                 return std::abs(std::remainder(root.value(), std::numbers::pi)) <=
                        std::hypot(kContradictionSigmas * noise_of(root),
                                   kModelSigmas * model_uncertainty_of(root));
               });
  return angles_rad;
}

/// Solves theta_e from both chords, without rho. Where the beams see the Earth at different
/// half-angles, their chord equations differ by
///
///     (cos gN - cos gS) cos(theta_e) + b sin(theta_e) = cos(rho_N) - cos(rho_S)
Uncertain earth_angle_from_both(const FixInput& input) {
  const ChordOf<Uncertain>& north = *input.north();
  const ChordOf<Uncertain>& south = *input.south();
  const double a = std::cos(north.mount_angle_rad) - std::cos(south.mount_angle_rad);
  const Uncertain b = std::sin(north.mount_angle_rad) * Uncertain{cos(0.5 * north.chord_rad)} -
                      std::sin(south.mount_angle_rad) * Uncertain{cos(0.5 * south.chord_rad)};
  const Uncertain difference =
      Uncertain{cos(input.disc_rad(Side::North))} - Uncertain{cos(input.disc_rad(Side::South))};
  const Uncertain sine =
      std::copysign(1.0, a) * difference / Uncertain{sqrt(Uncertain{a * a + b * b})};
  return earth_angle_from_two_chords(north, south) - Uncertain{asin(sine)};
}

/// Returns the roots of theta_e from the lone chord; without any it sets the reason.
std::vector<Uncertain> earth_angles_from_one(const FixInput& input, AxisSolutions& found) {
  const ChordOf<Uncertain>& chord = input.lone_chord();
  const Uncertain a = certain(std::cos(chord.mount_angle_rad));
  const Uncertain b = std::sin(chord.mount_angle_rad) * Uncertain{cos(0.5 * chord.chord_rad)};
  ConeRootsOf<Uncertain> roots = cone_roots(a, b, Uncertain{cos(input.lone_disc_rad())});
  note_near_tangent(roots.excess, found);
  // A chord narrower than this many sigmas is near-tangent: at five sigmas of noise the
  // second-order change of its cosine is a quarter of the first-order change.
  if (chord.chord_rad.value() < 10.0 * noise_of(chord.chord_rad)) {
    found.near_tangent = true;
  }
  if (!(roots.excess.value() < 0.0)) {
    found.reason = {NoFixCode::ChordTooWide,
                    {{"chord_deg", degrees(chord.chord_rad.value())},
                     {"disc_deg", degrees(input.lone_disc_rad().value())},
                     {"mount_angle_deg", degrees(chord.mount_angle_rad)}}};
  } else if (roots.angles_rad.empty()) {
    found.reason = {NoFixCode::NoEarthAngle};
  }
  return std::move(roots.angles_rad);
}

/// Returns the misfit of a root to the angle between Sun and Earth.
Uncertain misfit(const FixInput& input, const AxisAngles& place) {
  const Uncertain along =
      Uncertain{cos(place.sun_angle_rad)} * Uncertain{cos(place.earth_angle_rad)};
  const Uncertain sines =
      Uncertain{sin(place.sun_angle_rad)} * Uncertain{sin(place.earth_angle_rad)};
  const Uncertain off =
      along + sines * Uncertain{cos(place.dihedral_rad)} - std::cos(input.sun_earth_rad);
  return off.value() < 0.0 ? Uncertain{-off} : off;
}

/// Tests that the better root fits better beyond noise and model and that the other does not fit at
/// all. Noise that both share drops out of the difference, but may make the true one fit worse.
bool fits_beyond_doubt(const FixInput& input, const AxisAngles& better, const AxisAngles& worse) {
  const auto beyond_doubt = [](const Uncertain& value) {
    return value.value() > std::hypot(kContradictionSigmas * noise_of(value),
                                      kModelSigmas * model_uncertainty_of(value));
  };
  const Uncertain misfit_of_worse = misfit(input, worse);
  return beyond_doubt(misfit_of_worse) &&
         beyond_doubt(Uncertain{misfit_of_worse - misfit(input, better)});
}

/// Input of cases 2 and 3 with the dihedral.
OneChordInput<Uncertain> one_chord(const FixInput& input) {
  return {.chord = input.lone_chord(),
          .sun_angle_rad = *input.sun_angle,
          .dihedral_rad = *input.dihedral,
          .sun_earth_rad = input.sun_earth_rad,
          .disc_rad = input.lone_disc_rad()};
}

bool has_one_chord_with_all_else(const FixInput& input) {
  return input.sun_angle && input.dihedral && !input.both_chords();
}

void solve_one_chord(const FixInput& input, AxisSolutions& found) {
  const OneChordInput<Uncertain> measured = one_chord(input);
  const Uncertain delta = determinant(measured);
  const auto add = [&](const Uncertain& earth_angle_rad) {
    found.places.push_back({.sun_angle_rad = *input.sun_angle,
                            .earth_angle_rad = earth_angle_rad,
                            .dihedral_rad = *input.dihedral});
  };
  if (std::abs(delta.value()) >= input.config.geometry.determinant_usable &&
      std::abs(delta.value()) > kContradictionSigmas * noise_of(delta)) {
    const Uncertain earth_angle_rad = earth_angle_linear(measured);
    if (earth_angle_rad > 0.0 && earth_angle_rad < std::numbers::pi) {
      add(earth_angle_rad);
    } else {
      found.reason = {NoFixCode::OneChordContradicts};
    }
    return;
  }
  for (const Uncertain& earth_angle_rad : earth_angles_from_one(input, found)) {
    add(earth_angle_rad);
  }
}

/// Solves without the dihedral: cones about Sun and Earth meet in two axes.
void meet(const FixInput& input, const Uncertain& earth_angle_rad, AxisSolutions& found) {
  const Uncertain& sun_angle_rad = *input.sun_angle;
  const Uncertain cosine =
      (std::cos(input.sun_earth_rad) -
       Uncertain{cos(sun_angle_rad)} * Uncertain{cos(earth_angle_rad)}) /
      Uncertain{Uncertain{sin(sun_angle_rad)} * Uncertain{sin(earth_angle_rad)}};
  const Uncertain excess =
      cosine.value() < 0.0 ? Uncertain{-cosine - 1.0} : Uncertain{cosine - 1.0};
  note_near_tangent(excess, found);
  if (!(excess.value() < 0.0)) {
    found.reason = {NoFixCode::ConesApart,
                    {{"sun_angle_deg", degrees(sun_angle_rad.value())},
                     {"earth_angle_deg", degrees(earth_angle_rad.value())},
                     {"sun_earth_deg", degrees(input.sun_earth_rad)}}};
    return;
  }
  const Uncertain dihedral_rad = acos(cosine);
  found.places.push_back({sun_angle_rad, earth_angle_rad, dihedral_rad});
  found.places.push_back({sun_angle_rad, earth_angle_rad, -dihedral_rad});
}

/// Solves cases 4 to 6: theta_s from the dihedral and the angle between Sun and Earth.
void find_sun_angles(const FixInput& input, const Uncertain& earth_angle_rad,
                     AxisSolutions& found) {
  const Uncertain b = Uncertain{sin(earth_angle_rad)} * Uncertain{cos(*input.dihedral)};
  const ConeRootsOf<Uncertain> roots =
      cone_roots(Uncertain{cos(earth_angle_rad)}, b, certain(std::cos(input.sun_earth_rad)));
  note_near_tangent(roots.excess, found);
  const std::vector<Uncertain> sun_angles_rad = possible_angles(roots);
  if (sun_angles_rad.empty()) {
    found.reason = {NoFixCode::NoSunAngle};
  }
  for (const Uncertain& sun_angle_rad : sun_angles_rad) {
    found.places.push_back({sun_angle_rad, earth_angle_rad, *input.dihedral});
  }
}

/// Solves case 7 and its one-beam variants: sun angle and dihedral from their combination by sun2.
/// The roots are searched; their derivatives are those of an implicit function.
void unmix(const FixInput& input, const Uncertain& earth_angle_rad, AxisSolutions& found) {
  const MixedAzimuth mixed{.sensor = input.config.sun_sensor,
                           .azimuth_rad = input.mixed_azimuth->value(),
                           .earth_angle_rad = earth_angle_rad.value(),
                           .sun_earth_rad = input.sun_earth_rad};
  const SlitLags slit = slit_lags(mixed);
  // Either angle changes the misfit by at most its own change.
  Uncertain miss = certain(slit.nearest_miss);
  miss.derivatives() =
      earth_angle_rad.derivatives().cwiseAbs() + input.mixed_azimuth->derivatives().cwiseAbs();
  note_near_tangent(miss, found);
  if (slit.lags.empty()) {
    found.reason = {NoFixCode::NoSunAngleOfSlit2};
  }
  for (const SlitLag& lag : slit.lags) {
    Uncertain lag_rad = certain(lag.lag_rad);
    lag_rad.derivatives() = lag.to_earth_angle * earth_angle_rad.derivatives() +
                            lag.to_azimuth * input.mixed_azimuth->derivatives();
    const Uncertain sun_angle_rad = with_model_error(
        atan2(certain(std::tan(input.config.sun_sensor.slit_cant_rad)), Uncertain{sin(lag_rad)}),
        SunAngleError);
    found.places.push_back(
        {sun_angle_rad, earth_angle_rad,
         Uncertain{*input.mixed_azimuth + lag_rad + input.config.sun_sensor.slit_separation_rad}});
  }
}

}  // namespace

AxisSolutions solve_axis_angles(const FixInput& input) {
  AxisSolutions found;
  if (has_one_chord_with_all_else(input)) {
    solve_one_chord(input, found);
  } else {
    const std::vector<Uncertain> earth_angles = input.both_chords()
                                                    ? std::vector{earth_angle_from_both(input)}
                                                    : earth_angles_from_one(input, found);
    for (const Uncertain& earth_angle_rad : earth_angles) {
      if (input.sun_angle && input.dihedral) {
        found.places.push_back({*input.sun_angle, earth_angle_rad, *input.dihedral});
      } else if (input.sun_angle) {
        meet(input, earth_angle_rad, found);
      } else if (input.dihedral) {
        find_sun_angles(input, earth_angle_rad, found);
      } else {
        unmix(input, earth_angle_rad, found);
      }
    }
  }
  for (AxisAngles& place : found.places) {
    place.beams = input.beams;
  }
  return found;
}

void rank(const FixInput& input, AxisSolutions& found) {
  found.told_apart = found.places.size() == 1 && !found.near_tangent;
  if (found.places.size() < 2 || !has_one_chord_with_all_else(input)) {
    return;
  }
  std::sort(found.places.begin(), found.places.end(),
            [&](const AxisAngles& a, const AxisAngles& b) {
              return misfit(input, a).value() < misfit(input, b).value();
            });
  found.told_apart = !found.near_tangent &&
                     std::abs(determinant(one_chord(input)).value()) >
                         input.config.geometry.determinant_ambiguous &&
                     fits_beyond_doubt(input, found.places[0], found.places[1]);
}

}  // namespace spindrift
