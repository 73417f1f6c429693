/// @file
/// Orbit of the spacecraft, from an orbit ephemeris message or from two-body elements.

#pragma once

#include <utility>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Gives the state of the spacecraft at any time that the orbit covers.
class Orbit {
 public:
  explicit Orbit(OrbitEphemeris ephemeris) : source_{std::move(ephemeris)} {}
  explicit Orbit(KeplerOrbit orbit) : source_{orbit} {}

  /// @return NoCoverage, saying by how much `t` lies outside the ephemeris.
  Expected<OrbitState> at(TaiTime t) const {
    return std::visit([t](const auto& source) { return source.at(t); }, source_);
  }

  /// Returns the ephemeris; null for an orbit of elements.
  const OrbitEphemeris* ephemeris() const { return std::get_if<OrbitEphemeris>(&source_); }
  /// Returns the orbit of elements; null for an ephemeris.
  const KeplerOrbit* elements() const { return std::get_if<KeplerOrbit>(&source_); }

 private:
  std::variant<OrbitEphemeris, KeplerOrbit> source_;
};

}  // namespace spindrift
