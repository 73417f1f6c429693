/// @file
/// CCSDS Orbit Ephemeris Message (502.0-B, KVN) and its interpolation.

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class Interpolation {
  Lagrange,  ///< Separate polynomials for positions and velocities, degree + 1 points.
  Hermite,   ///< One polynomial through positions and velocities, (degree + 1) / 2 points.
};

/// Beyond this degree the end intervals oscillate and divided differences lose more than it gains.
inline constexpr int kMaxInterpolationDegree = 15;

struct EphemerisPoint {
  TaiTime t;
  OrbitState state;
  int line = 0;  ///< Line of the message that it was read from.
};

/// One metadata block with its data lines: states at strictly increasing times.
struct OemSegment {
  TaiTime usable_from;
  TaiTime usable_to;
  Interpolation interpolation;
  int degree;
  std::vector<EphemerisPoint> points;
  std::string object_name = {};  ///< OBJECT_NAME and OBJECT_ID of its metadata.
  std::string object_id = {};
};

/// Returns the points that one interpolation uses; at least two, so that it never extrapolates. An
/// even Hermite degree is raised by one: a point brings two conditions.
constexpr int points_needed(Interpolation interpolation, int degree) {
  const int points = interpolation == Interpolation::Lagrange ? degree + 1 : (degree + 2) / 2;
  return points < 2 ? 2 : points;
}

/// An interpolated ephemeris, valid by construction.
class OrbitEphemeris {
 public:
  /// @return InvalidConfiguration for no segment; for one whose points are too few for its degree,
  ///         out of order or do not reach its usable times; for segments out of order. Usable times
  ///         of successive segments may touch but not overlap.
  static Expected<OrbitEphemeris> make(std::vector<OemSegment> segments);

  /// Returns the state at `t`. Where two segments touch, the later one is used.
  /// @return NoCoverage, saying by how much `t` lies outside.
  Expected<OrbitState> at(TaiTime t) const;

  const std::vector<OemSegment>& segments() const { return segments_; }
  TaiTime usable_from() const { return segments_.front().usable_from; }
  TaiTime usable_to() const { return segments_.back().usable_to; }

 private:
  explicit OrbitEphemeris(std::vector<OemSegment> segments) : segments_{std::move(segments)} {}
  std::vector<OemSegment> segments_;
};

/// One line of a message, without its line end.
struct OemLine {
  int number;             ///< Line number, from 1.
  std::string_view text;  ///< Valid until the next line is read.
};

/// Returns the next line on each call, including blank ones; empty after the last.
using OemLines = std::function<Expected<std::optional<OemLine>>()>;

/// Reads an OEM. Accepts only Earth-centred orbits; EME2000 (J2000), ICRF or GCRF, treated as one
/// frame as their axes differ by 0.02 arcsec; UTC or TAI. A segment is usable where its USEABLE
/// times, its START and STOP times and its data lines overlap. Without INTERPOLATION: Hermite of
/// degree 7, less if the points are few, since every data line has a velocity. Accelerations and
/// covariances are checked for form only. Each state must follow from the one before (`jump_km` of
/// state_jump.h; smaller jumps are accepted, and `orbit_jumps` finds them); between segments the
/// velocity may change. Where missing lines lead the interpolation astray, there is no orbit
/// (`cut_at_holes`).
/// @return InvalidConfiguration with the line number, the key and what is allowed; errors of
///         `next_line`.
Expected<OrbitEphemeris> parse_oem(const OemLines& next_line);

/// Reads an OEM that is given as a whole text.
Expected<OrbitEphemeris> parse_oem(std::string_view text);

}  // namespace spindrift
