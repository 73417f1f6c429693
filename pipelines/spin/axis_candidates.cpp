#include "pipelines/spin/axis_candidates.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <unsupported/Eigen/AutoDiff>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/earth_motion.h"
#include "pipelines/spin/geometry.h"
#include "pipelines/spin/mixed_azimuth.h"

namespace spindrift {
namespace {

// Within this angle of one line, Sun and Earth leave the axis free to turn about it.
constexpr double kInLine_rad = 3.0 * std::numbers::pi / 180.0;

// What measurements may contradict each other by, beside kModelLimit_rad.
constexpr double kContradictionSigmas = 5.0;
constexpr double kGrazingSigmas = 3.0;
// One root fits better than another only beyond so many sigmas of noise: of the thousands of fixes
// of a pass, none is then the wrong one. And of the model, whose errors are drawn but once.
constexpr double kToldApartSigmas = 5.0;
constexpr double kToldApartModelSigmas = 3.0;
// A chord narrower than so many sigmas grazes: where noise of five sigmas changes its cosine, the
// second order is a quarter of the first.
constexpr double kNarrowSigmas = 10.0;
// The linear solution divides by Delta, which must not be its own noise.
constexpr double kDeterminantSigmas = 5.0;

/// An angle, or a function of angles, with its derivatives: to each edge for one standard deviation
/// of its time, then to each error of the model for a radian of it.
constexpr int kEdges = static_cast<int>(kPulseChannels);
using Value = Eigen::AutoDiffScalar<Eigen::Matrix<double, kEdges + kModelErrors, 1>>;

double noise_of(const Value& value) { return value.derivatives().head<kEdges>().norm(); }

/// One standard deviation of what the errors of the model make of it.
double model_uncertainty_of(const Value& value) {
  return value.derivatives().tail<kModelErrors>().norm() * kModelError_rad;
}

Value constant(double value) { return {value, Value::DerType::Zero()}; }

Value value_of(const Measured& measured) {
  Value value = constant(measured.value_rad);
  value.derivatives().head<kEdges>() = measured.noise_rad;
  return value;
}

Value with_model_error(Value value, ModelError error) {
  value.derivatives()(kEdges + error) += 1.0;
  return value;
}

/// What one revolution has to solve from.
struct Input {
  const SpinConfig& config;
  const RevolutionMeasurements& measured;
  const Sightlines& sightlines;
  double sun_earth_rad;
  std::optional<Value> sun_angle;
  std::optional<Value> dihedral;
  std::optional<Value> mixed_azimuth;
  std::array<std::optional<ChordOf<Value>>, 2> chords;

  const std::optional<ChordOf<Value>>& north() const { return chords[0]; }
  const std::optional<ChordOf<Value>>& south() const { return chords[1]; }
  bool both_chords() const { return north() && south(); }
  const ChordOf<Value>& lone_chord() const { return north() ? *north() : *south(); }
  /// rho, as the beam of the side sees it.
  Value disc_rad(Side side) const {
    return with_model_error(constant(sightlines.disc_rad),
                            side == Side::North ? NorthLimb : SouthLimb);
  }
  Value lone_disc_rad() const { return disc_rad(north() ? Side::North : Side::South); }
};

/// An axis by its angles to Sun and Earth and the dihedral between them.
struct Place {
  Value sun_angle_rad;
  Value earth_angle_rad;
  Value dihedral_rad;
};

/// What was found on the way to a solution.
struct Solutions {
  std::vector<Place> places;  ///< Best first.
  bool told_apart = true;
  bool grazing = false;
  std::string reason;  ///< Why there is none.
};

Unexpected unobservable(std::string message) {
  return Unexpected{{ErrorCode::Unobservable, std::move(message)}};
}

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

/// Cones that touch within noise and model. Where they miss each other by so little, the roots that
/// are missing may be the true ones.
/// @param excess By how much they miss each other, as a cosine; negative where they cross.
void note_grazing(const Value& excess, Solutions& found) {
  const bool grazing = std::abs(excess.value()) <=
                       kGrazingSigmas * std::hypot(noise_of(excess), model_uncertainty_of(excess));
  found.grazing = found.grazing || grazing;
  found.told_apart = found.told_apart && !grazing;
}

/// An azimuth that is the mean of those of the beams that have one.
Value with_azimuth_errors(Value value, bool north, bool south) {
  const double share = north && south ? 0.5 : 1.0;
  value.derivatives()(kEdges + NorthAzimuth) += north ? share : 0.0;
  value.derivatives()(kEdges + SouthAzimuth) += south ? share : 0.0;
  return value;
}

std::optional<Value> dihedral_of(const RevolutionMeasurements& measured) {
  const auto north = good_value_of(measured, SpinQuantity::NorthDihedral);
  const auto south = good_value_of(measured, SpinQuantity::SouthDihedral);
  if (!north && !south) {
    return std::nullopt;
  }
  const Measured mean =
      north && south ? mean_round_the_circle(*north, *south) : (north ? *north : *south);
  return with_azimuth_errors(value_of(mean), north.has_value(), south.has_value());
}

Input input_of(const SpinConfig& config, const RevolutionMeasurements& measured,
               const Sightlines& sightlines) {
  Input input{.config = config,
              .measured = measured,
              .sightlines = sightlines,
              .sun_earth_rad = angle_between_rad(sightlines.sun_icrf, sightlines.earth_icrf),
              .sun_angle = {},
              .dihedral = dihedral_of(measured),
              .mixed_azimuth = {},
              .chords = {}};
  if (const auto sun = good_value_of(measured, SpinQuantity::SunAngle)) {
    input.sun_angle = with_model_error(value_of(*sun), SunAngleError);
  }
  if (const auto mixed = good_value_of(measured, SpinQuantity::MixedAzimuth)) {
    const auto takes_part = [&](Side side) {
      return good_value_of(measured, kChords.at(index_of(side))).has_value();
    };
    input.mixed_azimuth =
        with_azimuth_errors(value_of(*mixed), takes_part(Side::North), takes_part(Side::South));
  }
  for (const Side side : kSides) {
    const auto chord = good_value_of(measured, kChords.at(index_of(side)));
    const auto& sensor = sensor_of(config, side);
    if (chord && sensor) {
      input.chords.at(index_of(side)) =
          ChordOf<Value>{.mount_angle_rad = sensor->mount_angle_rad, .chord_rad = value_of(*chord)};
    }
  }
  if (input.both_chords() &&
      mounted_alike(input.north()->mount_angle_rad, input.south()->mount_angle_rad)) {
    input.chords[1].reset();
  }
  return input;
}

/// theta_e from both chords. The limb of either beam enters by the difference of the two chord
/// equations, (cos gN - cos gS) cos(theta_e) + ... = cos(rho_N) - cos(rho_S).
Value earth_angle_from_both(const Input& input) {
  Value earth = earth_angle_from_two_chords(*input.north(), *input.south());
  const auto slope_of = [&](const ChordOf<Value>& chord) {
    const double mount_rad = chord.mount_angle_rad;
    return std::sin(mount_rad) * std::cos(0.5 * chord.chord_rad.value()) * std::cos(earth.value()) -
           std::cos(mount_rad) * std::sin(earth.value());
  };
  const double shift =
      -std::sin(input.sightlines.disc_rad) / (slope_of(*input.north()) - slope_of(*input.south()));
  earth.derivatives()(kEdges + NorthLimb) += shift;
  earth.derivatives()(kEdges + SouthLimb) -= shift;
  return earth;
}

/// The roots of theta_e by the lone chord; where there is none, the reason.
std::vector<Value> earth_angles_from_one(const Input& input, Solutions& found) {
  const ChordOf<Value>& chord = input.lone_chord();
  const Value a = constant(std::cos(chord.mount_angle_rad));
  const Value b = std::sin(chord.mount_angle_rad) * Value{cos(0.5 * chord.chord_rad)};
  ConeRootsOf<Value> roots = cone_roots(a, b, Value{cos(input.lone_disc_rad())});
  note_grazing(roots.excess, found);
  if (chord.chord_rad.value() < kNarrowSigmas * noise_of(chord.chord_rad)) {
    found.grazing = true;
    found.told_apart = false;
  }
  if (!(roots.excess.value() < 0.0)) {
    found.reason = fmt::format(
        "chord {:.4f} deg is wider than the Earth's disc of half-angle {:.4f} deg allows at "
        "mounting angle {:.4f} deg",
        degrees(chord.chord_rad.value()), degrees(input.sightlines.disc_rad),
        degrees(chord.mount_angle_rad));
  } else if (roots.angles_rad.empty()) {
    found.reason = "no earth angle in (0, 180) deg gives the measured chord";
  }
  return std::move(roots.angles_rad);
}

/// How badly a place fits the angle between Sun and Earth.
Value misfit(const Input& input, const Place& place) {
  const Value along = Value{cos(place.sun_angle_rad)} * Value{cos(place.earth_angle_rad)};
  const Value sines = Value{sin(place.sun_angle_rad)} * Value{sin(place.earth_angle_rad)};
  const Value off = along + sines * Value{cos(place.dihedral_rad)} - std::cos(input.sun_earth_rad);
  return off.value() < 0.0 ? Value{-off} : off;
}

/// Not only does one of them fit better: beyond noise and model it does so, and the other does not
/// fit at all. (Noise that both share drops out of the difference; it may have moved both so far
/// that the true one fits worse.)
bool fits_beyond_doubt(const Input& input, const Place& better, const Place& worse) {
  const auto beyond_doubt = [](const Value& value) {
    return value.value() > std::hypot(kToldApartSigmas * noise_of(value),
                                      kToldApartModelSigmas * model_uncertainty_of(value));
  };
  const Value misfit_of_worse = misfit(input, worse);
  return beyond_doubt(misfit_of_worse) &&
         beyond_doubt(Value{misfit_of_worse - misfit(input, better)});
}

/// Cases 2 and 3 with the dihedral.
Solutions from_one_chord(const Input& input) {
  const OneChordInput<Value> measured{.chord = input.lone_chord(),
                                      .sun_angle_rad = *input.sun_angle,
                                      .dihedral_rad = *input.dihedral,
                                      .sun_earth_rad = input.sun_earth_rad,
                                      .disc_rad = input.lone_disc_rad()};
  const Value signed_delta = determinant(measured);
  const double delta = std::abs(signed_delta.value());
  Solutions found;
  const auto add = [&](const Value& earth_angle_rad) {
    found.places.push_back({.sun_angle_rad = *input.sun_angle,
                            .earth_angle_rad = earth_angle_rad,
                            .dihedral_rad = *input.dihedral});
  };
  if (delta >= input.config.geometry.determinant_usable &&
      delta > kDeterminantSigmas * noise_of(signed_delta)) {
    const Value earth_angle_rad = earth_angle_linear(measured);
    if (earth_angle_rad > 0.0 && earth_angle_rad < std::numbers::pi) {
      add(earth_angle_rad);
    } else {
      found.reason =
          "the measured sun angle, chord and dihedral contradict each other: no earth angle in "
          "(0, 180) deg fits them";
    }
    return found;
  }
  for (const Value& earth_angle_rad : earth_angles_from_one(input, found)) {
    add(earth_angle_rad);
  }
  std::sort(found.places.begin(), found.places.end(), [&](const Place& a, const Place& b) {
    return misfit(input, a).value() < misfit(input, b).value();
  });
  if (found.places.size() > 1) {
    found.told_apart = found.told_apart && delta > input.config.geometry.determinant_ambiguous &&
                       fits_beyond_doubt(input, found.places[0], found.places[1]);
  }
  return found;
}

/// The dihedral withheld: cones about Sun and Earth meet in two axes.
void meet(const Input& input, const Value& earth_angle_rad, Solutions& found) {
  const Value& sun_angle_rad = *input.sun_angle;
  const Value cosine =
      (std::cos(input.sun_earth_rad) - Value{cos(sun_angle_rad)} * Value{cos(earth_angle_rad)}) /
      Value{Value{sin(sun_angle_rad)} * Value{sin(earth_angle_rad)}};
  const Value excess = cosine.value() < 0.0 ? Value{-cosine - 1.0} : Value{cosine - 1.0};
  note_grazing(excess, found);
  if (!(excess.value() < 0.0)) {
    found.reason = fmt::format(
        "the cones of {:.4f} deg about the Sun and {:.4f} deg about the Earth do not meet, which "
        "stand {:.4f} deg apart",
        degrees(sun_angle_rad.value()), degrees(earth_angle_rad.value()),
        degrees(input.sun_earth_rad));
    return;
  }
  const Value dihedral_rad = acos(cosine);
  found.places.push_back({sun_angle_rad, earth_angle_rad, dihedral_rad});
  found.places.push_back({sun_angle_rad, earth_angle_rad, -dihedral_rad});
}

/// Cases 4 to 6: theta_s from the dihedral and the angle between Sun and Earth.
void find_sun_angles(const Input& input, const Value& earth_angle_rad, Solutions& found) {
  const Value b = Value{sin(earth_angle_rad)} * Value{cos(*input.dihedral)};
  const ConeRootsOf<Value> roots =
      cone_roots(Value{cos(earth_angle_rad)}, b, constant(std::cos(input.sun_earth_rad)));
  note_grazing(roots.excess, found);
  if (roots.angles_rad.empty()) {
    found.reason = "no sun angle in (0, 180) deg fits the measured earth angle and dihedral";
  }
  for (const Value& sun_angle_rad : roots.angles_rad) {
    found.places.push_back({sun_angle_rad, earth_angle_rad, *input.dihedral});
  }
}

/// Case 7 and its like: sun angle and dihedral from their one combination that sun2 gives. The
/// roots are searched; their derivatives are those of an implicit function.
void unmix(const Input& input, const Value& earth_angle_rad, Solutions& found) {
  const MixedAzimuth mixed{.sensor = input.config.sun_sensor,
                           .azimuth_rad = input.mixed_azimuth->value(),
                           .earth_angle_rad = earth_angle_rad.value(),
                           .sun_earth_rad = input.sun_earth_rad};
  const SlitLags slit = slit_lags(mixed);
  // Neither angle moves the misfit by more than itself.
  Value miss = constant(slit.nearest_miss);
  miss.derivatives() =
      earth_angle_rad.derivatives().cwiseAbs() + input.mixed_azimuth->derivatives().cwiseAbs();
  note_grazing(miss, found);
  if (slit.lags.empty()) {
    found.reason = "no sun angle that sun slit 2 can see fits the measured earth angle and azimuth";
  }
  for (const SlitLag& lag : slit.lags) {
    Value lag_rad = constant(lag.lag_rad);
    lag_rad.derivatives() = lag.to_earth_angle * earth_angle_rad.derivatives() +
                            lag.to_azimuth * input.mixed_azimuth->derivatives();
    const Value sun_angle_rad = with_model_error(
        atan2(constant(std::tan(input.config.sun_sensor.slit_cant_rad)), Value{sin(lag_rad)}),
        SunAngleError);
    found.places.push_back(
        {sun_angle_rad, earth_angle_rad,
         Value{*input.mixed_azimuth + lag_rad + input.config.sun_sensor.slit_separation_rad}});
  }
}

Solutions solve(const Input& input) {
  if (input.sun_angle && input.dihedral && !input.both_chords()) {
    return from_one_chord(input);
  }
  Solutions found;
  const std::vector<Value> earth_angles = input.both_chords()
                                              ? std::vector{earth_angle_from_both(input)}
                                              : earth_angles_from_one(input, found);
  for (const Value& earth_angle_rad : earth_angles) {
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
  found.told_apart = found.told_apart && found.places.size() == 1;
  return found;
}

bool agrees(double contradiction, double noise) {
  return std::abs(contradiction) <= kContradictionSigmas * noise + kModelLimit_rad;
}

/// What it would be had no edge been late.
double in_time(const Value& value, const EdgeNoise& late) {
  return value.value() - value.derivatives().head<kEdges>().dot(late);
}

/// Both chords show the disc that the orbit gives.
bool disc_agrees(const Input& input, const Value& earth_angle_rad, const EdgeNoise& late) {
  const Value cosine = cos_disc_seen(*input.north(), earth_angle_rad);
  if (!(std::abs(cosine.value()) < 1.0)) {
    return false;
  }
  const Value disc_rad = acos(cosine);
  return agrees(in_time(disc_rad, late) - input.sightlines.disc_rad, noise_of(disc_rad));
}

AxisCandidate candidate_at(const Input& input, const Place& place) {
  const Eigen::Matrix<Value, 3, 1> axis =
      axis_icrf(AxisInput<Value>{.sun_icrf = input.sightlines.sun_icrf,
                                 .earth_icrf = input.sightlines.earth_icrf,
                                 .sun_angle_rad = place.sun_angle_rad,
                                 .earth_angle_rad = place.earth_angle_rad,
                                 .dihedral_rad = place.dihedral_rad});
  Eigen::Vector3d solved;
  Eigen::Matrix<double, 3, kEdges + kModelErrors> shifts;
  for (Eigen::Index i = 0; i < 3; ++i) {
    solved[i] = axis[i].value();
    shifts.row(i) = axis[i].derivatives();
  }
  const EdgeNoise late =
      late_by_earth_motion(input.config, input.measured, input.sightlines, solved.normalized());
  solved -= shifts.leftCols<kEdges>() * late;
  const double norm = solved.norm();
  const Eigen::Vector3d unit = solved / norm;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(unit);
  const Eigen::Matrix<double, 2, kEdges + kModelErrors> tangent = basis.transpose() * shifts / norm;
  const auto noise = tangent.leftCols<kEdges>();
  const double norm_noise = (unit.transpose() * shifts.leftCols<kEdges>()).norm();
  return {.axis_icrf = unit,
          .covariance_rad2 = noise * noise.transpose(),
          .norm = norm,
          .consistent = agrees(norm - 1.0, norm_noise) &&
                        (!input.both_chords() || disc_agrees(input, place.earth_angle_rad, late)),
          .model_shift_icrf = basis * tangent.rightCols<kModelErrors>()};
}

std::string cone_in_words(int geometry_case) {
  switch (geometry_case) {
    case 8:
      return "both chords without a sun pulse: a cone about the Earth only";
    case 9:
      return "a sun angle without a chord: a cone about the Sun only";
    case 10:
      return "a chord alone: one or two cones about the Earth only";
    default:
      return "no measurement that an axis could be found from";
  }
}

/// Near a double root, or where nothing fixes a direction, the linear covariance has no meaning.
bool determined(const AxisCandidate& candidate) {
  constexpr double kLost_rad = 0.5;
  return candidate.covariance_rad2.trace() < kLost_rad * kLost_rad;
}

}  // namespace

int geometry_case_of(const RevolutionMeasurements& measured) {
  using enum SpinQuantity;
  const auto has = [&](SpinQuantity quantity) {
    return good_value_of(measured, quantity).has_value();
  };
  const bool north = has(NorthChord);
  const bool south = has(SouthChord);
  // Both, north, south: in this order of cases.
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

bool contradicts_itself(const Expected<AxisCandidates>& found) {
  if (!found) {
    return found.error().code == ErrorCode::InvalidInput;
  }
  return std::none_of(found->candidates.begin(), found->candidates.end(),
                      [](const AxisCandidate& candidate) { return candidate.consistent; });
}

Expected<AxisCandidates> axis_candidates(const SpinConfig& config,
                                         const RevolutionMeasurements& measured,
                                         const Sightlines& sightlines) {
  AxisCandidates result{.geometry_case = geometry_case_of(measured),
                        .candidates = {},
                        .told_apart = false,
                        .grazing = false};
  if (result.geometry_case < 1 || result.geometry_case > 7) {
    return unobservable(cone_in_words(result.geometry_case));
  }
  const Input input = input_of(config, measured, sightlines);
  if (!(input.sun_earth_rad > kInLine_rad &&
        input.sun_earth_rad < std::numbers::pi - kInLine_rad)) {
    return unobservable(
        fmt::format("Sun and Earth stand {:.3f} deg apart: the axis needs between 3 and 177 deg",
                    degrees(input.sun_earth_rad)));
  }
  const Solutions found = solve(input);
  if (found.places.empty()) {
    return found.grazing ? unobservable(found.reason)
                         : Unexpected{{ErrorCode::InvalidInput, found.reason}};
  }
  for (const Place& place : found.places) {
    result.candidates.push_back(candidate_at(input, place));
    if (!determined(result.candidates.back())) {
      return unobservable(
          "the solution is lost in the noise of its edges: it exists only within "
          "one sigma of them, or no measurement fixes one of its directions");
    }
  }
  result.told_apart = found.told_apart;
  result.grazing = found.grazing;
  if (!input.both_chords() && result.geometry_case % 3 == 1) {
    ++result.geometry_case;  // Both chords, of beams mounted alike: only north's is used.
  }
  return result;
}

}  // namespace spindrift
